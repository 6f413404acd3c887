# SPDX-License-Identifier: GPL-3.0-or-later
"""Windows ends the renderer's process with the one that started it, as Linux does by a signal (bootstrap.py).

The end of the pipe says so as well, but is not seen while the driver computes and holds the interpreter. A job object
with this limit ends its processes when its last handle is closed, which the system does for whoever dies
(learn.microsoft.com, "Job Objects", JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE).
"""

import ctypes
import functools
import logging
import subprocess
import sys

logger = logging.getLogger(__name__)

_EXTENDED_LIMITS = 9
_KILL_ON_CLOSE = 0x2000


class _BasicLimits(ctypes.Structure):
    """JOBOBJECT_BASIC_LIMIT_INFORMATION."""

    _fields_ = [
        ("process_time", ctypes.c_int64),
        ("job_time", ctypes.c_int64),
        ("flags", ctypes.c_uint32),
        ("least_working_set", ctypes.c_size_t),
        ("most_working_set", ctypes.c_size_t),
        ("processes", ctypes.c_uint32),
        ("affinity", ctypes.c_size_t),
        ("priority_class", ctypes.c_uint32),
        ("scheduling_class", ctypes.c_uint32),
    ]


class ExtendedLimits(ctypes.Structure):
    """JOBOBJECT_EXTENDED_LIMIT_INFORMATION."""

    _fields_ = [
        ("basic", _BasicLimits),
        ("transfers", ctypes.c_uint64 * 6),
        ("process_memory", ctypes.c_size_t),
        ("job_memory", ctypes.c_size_t),
        ("peak_process_memory", ctypes.c_size_t),
        ("peak_job_memory", ctypes.c_size_t),
    ]


def end_with_this_process(process: "subprocess.Popen[bytes]") -> None:
    """Have a started process end when this one does, whatever ends it. Without effect but on Windows."""
    if sys.platform != "win32":
        return
    try:
        kernel = _kernel()
        # A process handle is the system's to know; subprocess has no public name for it.
        if not kernel.AssignProcessToJobObject(_job(), ctypes.c_void_p(int(process._handle))):
            raise ctypes.WinError(ctypes.get_last_error())
    except OSError as error:  # the end of the pipe has to do
        logger.warning("the renderer's process does not end with this one at once: %s", error)


def _kernel() -> "ctypes.CDLL":
    """The functions of kernel32, whose errors ctypes.get_last_error returns."""
    if sys.platform != "win32":
        raise OSError("there are job objects on Windows alone")
    kernel = ctypes.WinDLL("kernel32", use_last_error=True)
    kernel.CreateJobObjectW.restype = ctypes.c_void_p
    kernel.CreateJobObjectW.argtypes = [ctypes.c_void_p, ctypes.c_wchar_p]
    kernel.SetInformationJobObject.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p, ctypes.c_uint32]
    kernel.AssignProcessToJobObject.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
    return kernel


@functools.cache
def _job() -> int:
    """The one job of this process, whose handle nobody inherits and only the system closes. Raises OSError."""
    if sys.platform != "win32":
        raise OSError("there are job objects on Windows alone")
    kernel = _kernel()
    job = kernel.CreateJobObjectW(None, None)
    limits = ExtendedLimits(basic=_BasicLimits(flags=_KILL_ON_CLOSE))
    if not job or not kernel.SetInformationJobObject(
        job, _EXTENDED_LIMITS, ctypes.byref(limits), ctypes.sizeof(limits)
    ):
        raise ctypes.WinError(ctypes.get_last_error())
    return int(job)
