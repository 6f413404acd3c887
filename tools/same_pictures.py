# SPDX-License-Identifier: GPL-3.0-or-later
"""Twenty pictures, equal bit for bit before and after a change that is to change none.

    python tools/same_pictures.py write out/before.json     # in the old checkout
    python tools/same_pictures.py compare out/before.json   # in the new one: names what differs, exit status 1

Run it with the checkout's own interpreter, on the same machine and driver. A picture is known by the SHA-256 of its
channels (headers name times). Pictures of files that are not part of the repository are left out where these are
missing (--scenes).
"""

import argparse
import hashlib
import json
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import OpenEXR

ROOT = Path(__file__).resolve().parents[1]
SAMPLES = ROOT / "docs" / "samples"


@dataclass(frozen=True)
class Case:
    """A picture: a file, what is set in it and the arguments of one render or of several that follow each other."""

    file: str
    sets: tuple[str, ...] = ()
    runs: tuple[tuple[str, ...], ...] = (("--samples", "3"),)
    merge: bool = False
    """Whether the runs are parts of one still."""
    frames: bool = False
    photons: int = 8192


_CAMERA = "camera.data"
_PASSES = (
    "Depth,Normal,UV,Mist,Diffuse Direct,Diffuse Indirect,Diffuse Color,Glossy Direct,Glossy Indirect,"
    "Transmission Direct,Transmission Indirect,Emission,Environment,Caustics,Denoising Albedo,Object Index"
)
CASES = {
    "room of glass": Case("first_light"),
    "rasterized splats": Case("first_light", ("rppm.density_estimation=RASTERIZED",)),
    "splat roulette": Case(
        "first_light",
        ("rppm.density_estimation=RASTERIZED",),
        runs=(("--samples", "3", "--use-splat-roulette"),),
    ),
    "photons alone": Case("first_light", ("rppm.direct_light=PHOTONS", "rppm.use_final_gather=false")),
    "radii of all pixels alike": Case("pool", ("rppm.use_adaptive_radius=false",)),
    "pool": Case("pool"),
    "shadow catcher": Case("pool", ('objects["Deck"].is_shadow_catcher=true', "render.film_transparent=true")),
    "holdout": Case("pool", ('objects["Ball"].is_holdout=true', "render.film_transparent=true")),
    "lens": Case("pool", (f"{_CAMERA}.dof.use_dof=true", f"{_CAMERA}.dof.aperture_fstop=0.2")),
    "panorama": Case("pool", (f"{_CAMERA}.type=PANO",)),
    "orthographic": Case("pool", (f"{_CAMERA}.type=ORTHO",)),
    "blur of motion": Case("spotlight", ("render.use_motion_blur=true",)),
    "frames": Case("spotlight", runs=(("--frames", "1..3", "--samples", "2"),), frames=True),
    "passes": Case("first_light", runs=(("--samples", "3", "--passes", _PASSES),)),
    "passes beside a catcher": Case(
        "pool",
        ('objects["Deck"].is_shadow_catcher=true', "render.film_transparent=true"),
        runs=(("--samples", "3", "--passes", _PASSES + ",Shadow Catcher"),),
    ),
    "noise threshold": Case("spotlight", runs=(("--samples", "48", "--adaptive-threshold", "0.2"),)),
    "learned": Case("spotlight", runs=(("--samples", "6"),)),
    "resumed": Case(
        "spotlight",
        runs=(
            ("--samples", "3", "--checkpoint", "{folder}/checkpoint.exr"),
            ("--samples", "6", "--checkpoint", "{folder}/checkpoint.exr", "--resume"),
        ),
    ),
    "merged": Case("spotlight", runs=(("--samples-range", "0:3"), ("--samples-range", "3:6")), merge=True),
    "dupli lights": Case("bseed_duplis_dupli_lights"),
    "many kinds of lights": Case("gltfio_04_lights"),
    "transparency": Case("bseed_object_alpha_object_alpha"),
    "transmission": Case("gltfio_14_transmission"),
    "camera shift": Case("bseed_cameras_camera_shift"),
    "caustic of water": Case("water_caustic_cornell"),
}
EQUAL = ("learned", "resumed")
"""These are one picture."""
SHAPE = "96x64"


class RenderFailed(Exception):
    """The program said no."""


def run(arguments: list[str]) -> None:
    """The rppm of this checkout."""
    command = [sys.executable, "-c", "import sys; from rppm_addon.cli import main; sys.exit(main())", *arguments]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if done.returncode:
        raise RenderFailed(" ".join(arguments) + "\n" + done.stderr[-2000:])


def digest(pictures: list[Path]) -> str:
    """SHA-256 over all channels of all parts."""
    if not pictures:
        raise RenderFailed("no picture was written")
    found = hashlib.sha256()
    for picture in pictures:
        with OpenEXR.File(str(picture), separate_channels=True) as file:
            for part in file.parts:
                for name in sorted(part.channels):
                    found.update(name.encode())
                    found.update(part.channels[name].pixels.tobytes())
    return found.hexdigest()


def render(case: Case, file: Path, folder: Path) -> str:
    """The digest of a case's picture."""
    parts = []
    for number, run_arguments in enumerate(case.runs):
        picture = folder / (f"part{number}.exr" if case.merge else "picture_####.exr" if case.frames else "picture.exr")
        parts.append(picture)
        options = [argument.format(folder=folder) for argument in run_arguments]
        # What a file allows itself in seconds would end a render whose programs are compiled first.
        sets = [item for name in (*case.sets, "rppm.time_limit=0") for item in ("--set", name)]
        shape = ["--resolution", SHAPE, "--photons", str(case.photons)]
        run(["render", str(file), "-o", str(picture), *shape, *options, *sets])
    if case.merge:
        run(["merge", *map(str, parts), "-o", str(folder / "picture.exr")])
        return digest([folder / "picture.exr"])
    return digest(sorted(folder.glob("picture*.exr")))


def file_of(case: Case, scenes: Path) -> Path | None:
    """Where a case's file is, if it is there."""
    for folder in (SAMPLES, scenes):
        path = folder / f"{case.file}.blend"
        if path.exists():
            return path
    return None


def render_all(scenes: Path, only: list[str]) -> dict[str, str]:
    """Digests by case."""
    found = {}
    for name, case in CASES.items():
        file = file_of(case, scenes)
        if file is None or (only and name not in only):
            continue
        start = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            found[name] = render(case, file, Path(folder))
        print(f"{name:28} {found[name][:16]} {time.monotonic() - start:5.1f} s", flush=True)
    one = {found[name] for name in EQUAL if name in found}
    if len(one) > 1:
        raise RenderFailed(f"{', '.join(EQUAL)} differ")
    return found


def main() -> int:
    """Write or compare as the command line says; returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("action", choices=("write", "compare"))
    parser.add_argument("file", type=Path)
    parser.add_argument("--scenes", type=Path, default=ROOT.parent / "shared" / "scenes")
    parser.add_argument("--only", nargs="*", default=[], metavar="CASE", help=", ".join(CASES))
    options = parser.parse_args()
    found = render_all(options.scenes, options.only)
    if options.action == "write":
        options.file.parent.mkdir(parents=True, exist_ok=True)
        options.file.write_text(json.dumps(found, indent=1))
        return 0
    before = json.loads(options.file.read_text())
    different = [name for name in found if before.get(name) != found[name]]
    print(f"{len(found) - len(different)} of {len(found)} equal" + "".join(f"\ndiffers: {name}" for name in different))
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
