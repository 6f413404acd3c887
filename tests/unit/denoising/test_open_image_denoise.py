# SPDX-License-Identifier: GPL-3.0-or-later
"""Open Image Denoise by its C interface, and where it is found."""

import ctypes
import os
import sys
from pathlib import Path

import numpy as np
import pytest

from rppm_addon.denoising import library as library_module
from rppm_addon.denoising import places as places_module
from rppm_addon.denoising.denoiser import Denoiser
from rppm_addon.denoising.library import OpenImageDenoise
from rppm_addon.denoising.places import LibraryPlace, Source, library_places
from rppm_addon.scene import RenderSettings
from rppm_addon.scene.errors import DenoiserError
from rppm_addon.scene.settings import DenoisingInputPasses, DenoisingPrefilter, DenoisingQuality

SIZE, NOISE = 96, 0.2


@pytest.fixture(scope="module")
def place():
    found = library_places()
    if not found:
        pytest.skip("there is no Open Image Denoise: install the bpy module (make setup) or pyoidn")
    return found[0]


@pytest.fixture(scope="module")
def library(place):
    library = OpenImageDenoise(place.path, threads=1)
    yield library
    library.release()


@pytest.fixture(scope="module")
def truth():
    """A bright square on a ground that grows brighter, beyond what a display shows."""
    ground = np.linspace(0.5, 4.0, SIZE)[None, :, None] * np.ones((SIZE, 1, 3))
    ground[30:60, 20:70] = (8.0, 6.0, 1.0)
    return ground.astype(np.float32)


@pytest.fixture(scope="module")
def noisy(truth):
    noise = np.random.default_rng(7).normal(0.0, NOISE, truth.shape)
    return (truth * (1.0 + noise)).astype(np.float32)


@pytest.mark.parametrize("quality", DenoisingQuality)
def test_noise_goes_and_energy_stays(library, truth, noisy, quality):
    denoised = library.filter({"color": noisy}, quality, hdr=True)

    def error(picture):
        return float((((picture - truth) / truth) ** 2).mean())

    assert denoised.shape == truth.shape and denoised.dtype == np.float32
    assert error(noisy) == pytest.approx(NOISE**2, rel=0.05)
    assert error(denoised) < 0.1 * error(noisy)
    # The noise itself moves the mean by NOISE / SIZE / sqrt(3), an eighth of a percent.
    assert denoised.mean() == pytest.approx(noisy.mean(), rel=0.01)


def test_the_picture_given_is_not_touched_and_the_same_picture_gives_the_same(library, noisy):
    before = noisy.copy()
    first, second = (library.filter({"color": noisy}, DenoisingQuality.HIGH, hdr=True) for _ in range(2))
    np.testing.assert_array_equal(noisy, before)
    np.testing.assert_array_equal(first, second)


def test_the_first_row_stays_the_first(library, truth, noisy):
    upright = library.filter({"color": noisy}, DenoisingQuality.HIGH, hdr=True)
    assert upright[45, 45, 0] == pytest.approx(truth[45, 45, 0], rel=0.1)
    assert upright[75, 45, 0] == pytest.approx(truth[75, 45, 0], rel=0.1)
    wide = library.filter({"color": noisy[:40]}, DenoisingQuality.HIGH, hdr=True)
    assert wide.shape == (40, SIZE, 3)


def test_albedo_keeps_a_texture(place, truth):
    """Stripes as fine as the noise, which the albedo knows."""
    random = np.random.default_rng(3)
    albedo = np.where(np.arange(SIZE)[None, :, None] % 4 < 2, 0.2, 0.8) * np.ones((SIZE, 1, 3))
    exact = np.concatenate([albedo, np.ones((SIZE, SIZE, 1))], axis=-1).astype(np.float32)
    picture = exact.copy()
    picture[..., :3] *= 1.0 + random.normal(0.0, 0.6, albedo.shape)
    picture[..., 3] = random.uniform(0.0, 1.0, (SIZE, SIZE))
    passes = {"Denoising Albedo": albedo, "Denoising Normal": np.zeros_like(albedo)}
    denoiser, errors = Denoiser([place]), {}
    for inputs in DenoisingInputPasses:
        for prefilter in DenoisingPrefilter:
            settings = RenderSettings(use_denoising=True, denoising_input_passes=inputs, denoising_prefilter=prefilter)
            denoised = denoiser.denoise(picture, passes, settings)
            np.testing.assert_array_equal(denoised[..., 3], picture[..., 3])
            errors[inputs, prefilter] = float(np.square(denoised - exact)[..., :3].mean())
    alone = errors[DenoisingInputPasses.RGB, DenoisingPrefilter.ACCURATE]
    for inputs in (DenoisingInputPasses.RGB_ALBEDO, DenoisingInputPasses.RGB_ALBEDO_NORMAL):
        assert max(errors[inputs, prefilter] for prefilter in DenoisingPrefilter) < 0.5 * alone


def test_what_is_not_finite_does_not_spread(place, noisy):
    picture = np.concatenate([noisy, np.ones((SIZE, SIZE, 1), np.float32)], axis=-1)
    picture[5, 5, :3], picture[80, 9, 1] = np.nan, -np.inf
    settings = RenderSettings(use_denoising=True, denoising_input_passes=DenoisingInputPasses.RGB)
    assert np.isfinite(Denoiser([place]).denoise(picture, {}, settings)).all()


def test_a_filter_that_fails_says_why(library, noisy):
    with pytest.raises(DenoiserError, match=r"cannot denoise the picture \(.+\); turn Denoise off"):
        library.filter({"colour": noisy}, DenoisingQuality.HIGH)
    assert library.filter({"color": noisy}, DenoisingQuality.HIGH, hdr=True).shape == noisy.shape


def test_files_that_are_no_such_library(tmp_path, place):
    with pytest.raises(DenoiserError, match="is not there; name the file"):
        OpenImageDenoise(tmp_path / "nowhere.so")
    text = tmp_path / "text.so"
    text.write_text("no library")
    with pytest.raises(DenoiserError, match="cannot be loaded .+; name another"):
        OpenImageDenoise(text)
    other = next(path for path in place.path.parent.iterdir() if path.name.startswith("libOpenImageDenoise_core"))
    with pytest.raises(DenoiserError, match="is no Open Image Denoise library of version 2 .+oidn"):
        OpenImageDenoise(other)


def test_images_that_are_copied_to_the_device_are_denoised_alike(library, place, noisy):
    copying = OpenImageDenoise(place.path, threads=1, copies_images=True)
    images = {"color": noisy, "albedo": noisy.clip(0.0, 1.0)}
    found, expected = (which.filter(images, DenoisingQuality.FAST, hdr=True) for which in (copying, library))
    copying.release()
    np.testing.assert_allclose(found, expected, rtol=1e-5)


class FakeLibrary:
    """Stands in for the file of a version, and notes the quality that is asked for."""

    def __init__(self, version):
        self.functions, self.qualities = {}, []
        self.results = {"oidnGetDeviceInt": lambda *_: version, "oidnSetFilterInt": self.set_quality}

    def set_quality(self, filter_, name, value):
        self.qualities.append(value)

    def __getattr__(self, name):
        return self.functions.setdefault(name, lambda *given: self.results.get(name, lambda *_: 0)(*given))


class FakeGpu(FakeLibrary):
    """A library that knows the processor and a GPU, and fills the pictures of the GPU with a number."""

    def __init__(self):
        super().__init__(20303)
        self.opened, self.buffers = [], []
        self.results |= {
            "oidnGetNumPhysicalDevices": lambda: 2,
            "oidnGetPhysicalDeviceInt": lambda number, name: (1, 3)[number],
            "oidnGetPhysicalDeviceString": lambda number, name: (b"A processor", b"A card")[number],
            "oidnNewDeviceByID": self.open_device,
            "oidnNewBuffer": self.add_buffer,
            "oidnReleaseBuffer": self.release_buffer,
            "oidnReadBuffer": self.fill,
        }

    def open_device(self, number):
        self.opened.append(number)
        return 7

    def add_buffer(self, device, size):
        self.buffers.append(size)
        return len(self.buffers)

    def release_buffer(self, buffer):
        self.buffers[buffer - 1] = None

    def fill(self, buffer, offset, size, address):
        np.ctypeslib.as_array((ctypes.c_float * (size // 4)).from_address(address))[:] = 0.25


@pytest.fixture
def fake_gpu(monkeypatch, tmp_path):
    """Stands for all files of libraries, of which there is library.so."""
    fake = FakeGpu()
    (tmp_path / "library.so").touch()
    monkeypatch.setattr(ctypes, "CDLL", lambda path: fake)
    return fake


def test_a_gpu_denoises_where_the_library_knows_one(fake_gpu, tmp_path):
    library = OpenImageDenoise(tmp_path / "library.so", use_gpu=True)
    assert (fake_gpu.opened, library.device_name) == ([1], "A card")
    denoised = library.filter({"color": np.ones((2, 3, 3))}, DenoisingQuality.HIGH)
    assert (denoised == 0.25).all() and fake_gpu.buffers == [None, None]
    assert OpenImageDenoise(tmp_path / "library.so").device_name == "the processor"


def test_a_gpu_without_memory_gets_its_buffers_back(fake_gpu, tmp_path):
    """Otherwise each failure would leave less of it, which the renderer needs as well."""
    library = OpenImageDenoise(tmp_path / "library.so", use_gpu=True)
    fake_gpu.results["oidnGetDeviceError"] = lambda *_: len(fake_gpu.buffers) > 1
    with pytest.raises(DenoiserError, match="too little memory on its device"):
        library.filter({"color": np.ones((2, 3, 3))}, DenoisingQuality.HIGH)
    assert fake_gpu.buffers[0] is None


def test_without_a_gpu_the_processor_denoises(place, noisy):
    settings = RenderSettings(
        use_denoising=True, denoising_use_gpu=True, denoising_input_passes=DenoisingInputPasses.RGB
    )
    picture = np.concatenate([noisy, np.ones_like(noisy[..., :1])], axis=-1)
    denoised = Denoiser([place]).denoise(picture, {}, settings)
    assert denoised[..., :3].std() < noisy.std()


@pytest.fixture
def open_version(monkeypatch, tmp_path):
    """open_version(number): a library of that version, and what stands in for its file."""
    (tmp_path / "library.so").touch()

    def open_version(number):
        fake = FakeLibrary(number)
        monkeypatch.setattr(ctypes, "CDLL", lambda path: fake)
        return OpenImageDenoise(tmp_path / "library.so"), fake

    return open_version


def test_another_version_is_refused(open_version):
    with pytest.raises(DenoiserError, match="is version 3.1.2 of Open Image Denoise; take one of version 2"):
        open_version(30102)


@pytest.mark.parametrize(("number", "version", "is_balanced"), [(20201, "2.2.1", True), (20303, "2.3.3", False)])
def test_fast_is_balanced_before_version_2_3(open_version, number, version, is_balanced):
    library, fake = open_version(number)
    assert library.version == version
    for quality in (DenoisingQuality.FAST, DenoisingQuality.BALANCED):
        library.filter({"color": np.ones((2, 2, 3))}, quality)
    assert (fake.qualities[0] == fake.qualities[1]) == is_balanced


def test_the_order_of_the_places(tmp_path, monkeypatch):
    """Blender's, the wheel's, the chosen one; what is not there is left out, but for what the user names."""
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    monkeypatch.delenv(places_module.VARIABLE, raising=False)
    name = places_module.LIBRARY_NAME
    blender, wheel = tmp_path / "blender-5" / "lib", tmp_path / "pyoidn" / "oidn" / "lib"
    for folder in (blender, wheel):
        folder.mkdir(parents=True)
        (folder / name).touch()
    (tmp_path / "pyoidn" / "__init__.py").touch()
    found = library_places(blender.parent, "/mine.so")
    assert found == [
        LibraryPlace(Source.BLENDER, blender / name),
        LibraryPlace(Source.WHEEL, wheel / name),
        LibraryPlace(Source.PATH, Path("/mine.so")),
    ]
    assert "pyoidn" not in sys.modules
    monkeypatch.setenv(places_module.VARIABLE, "/other.so")
    assert library_places(blender.parent)[-1].path == Path("/other.so")
    (blender / name).unlink()
    (wheel / name).unlink()
    assert library_places(blender.parent, "/mine.so") == [LibraryPlace(Source.PATH, Path("/mine.so"))]


def test_a_distribution_has_it_among_its_libraries(tmp_path):
    (tmp_path / "bin").mkdir()
    (tmp_path / "lib64").mkdir()
    library = tmp_path / "lib64" / places_module.LIBRARY_NAME
    library.touch()
    assert library_places(tmp_path / "bin")[0].path.samefile(library)


def test_the_next_place_is_tried_and_the_remedy_is_named(tmp_path, place):
    broken = LibraryPlace(Source.PATH, tmp_path / "none.so")
    denoiser = Denoiser([broken, place])
    assert denoiser.description.startswith(f"Open Image Denoise {denoiser.open().version} of {place.source.value}")
    for places in ([], [broken]):
        with pytest.raises(DenoiserError, match=r"pip install rppm-addon\[denoise\]") as raised:
            Denoiser(places).open()
        assert ("none.so" in str(raised.value)) == bool(places)


def test_threads_are_those_of_the_process(monkeypatch):
    if not hasattr(os, "sched_getaffinity"):
        pytest.skip("this system does not say on which processors a process may run")
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 2, 5})
    assert library_module.usable_cores() == 3


def test_signatures_are_complete(open_version):
    """A function without argument types would cut pointers to 32 bits."""
    _, fake = open_version(20303)
    assert len(fake.functions) > 10
    for function in fake.functions.values():
        assert function.restype in (None, ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p)
        assert function.argtypes or function is fake.functions["oidnGetNumPhysicalDevices"]
