# SPDX-License-Identifier: GPL-3.0-or-later
"""Quantities as short texts."""


def count_text(count: float) -> str:
    """A count with three digits: 950, 65.5 k, 8.39 M, 1.20 G."""
    for power, unit in ((1e9, " G"), (1e6, " M"), (1e3, " k")):
        if count >= power:
            value = count / power
            return f"{value:.{max(0, 3 - len(str(int(value))))}f}{unit}"
    return f"{count:.0f}"


def bytes_text(size: float) -> str:
    """Bytes in binary units: 512 B, 64.0 KiB, 79.1 MiB, 1.50 GiB."""
    for power, unit, digits in ((30, "GiB", 2), (20, "MiB", 1), (10, "KiB", 1)):
        if size >= 1 << power:
            return f"{size / (1 << power):.{digits}f} {unit}"
    return f"{size:.0f} B"


def seconds_text(seconds: float) -> str:
    """A duration: 0.25 s, 12.3 s, 2:05 min, 1:02:05 h."""
    if seconds < 60.0:
        return f"{seconds:.2f} s" if seconds < 10.0 else f"{seconds:.1f} s"
    whole = round(seconds)
    minutes, hours = whole // 60, whole // 3600
    return f"{hours}:{minutes % 60:02d}:{whole % 60:02d} h" if hours else f"{minutes}:{whole % 60:02d} min"


def clock_text(seconds: float, with_hours: bool = False) -> str:
    """A time that is left, to whole seconds: 00:04, 12:30, 1:02:05; with hours 00:12:30."""
    whole = round(seconds)
    minutes, hours = whole // 60 % 60, whole // 3600
    if with_hours:
        return f"{hours:02d}:{minutes:02d}:{whole % 60:02d}"
    return f"{hours}:{minutes:02d}:{whole % 60:02d}" if hours else f"{minutes:02d}:{whole % 60:02d}"


def noise_text(noise: float, threshold: float) -> str:
    """Noise and where a render ends: 0.0213 of 0.01."""
    return f"{noise:.3g} of {threshold:g}"


def rate_text(rate: float) -> str:
    """Something a second, without its name: 0.25, 12.3, 950, 65.5 k."""
    return count_text(rate) if rate >= 100.0 else f"{rate:.3g}"
