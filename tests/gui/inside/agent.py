# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside Blender: does the steps that the test outside asks for, one at a time, from a timer of the window.

Started as ``blender FILE --python agent.py -- FOLDER``. FOLDER/request.json holds [name, arguments] of a function of
one of MODULES; its result, or the error, goes to FOLDER/answer.json. Both files appear whole, by renaming.
"""

import importlib
import json
import os
import sys
import traceback
from pathlib import Path

import bpy

POLL_SECONDS = 0.01
MODULES = ("window_steps", "viewport_steps", "panel_steps", "bake_steps", "soak_steps")

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
steps = [importlib.import_module(name) for name in MODULES]
folder = Path(sys.argv[sys.argv.index("--") + 1])


def poll() -> float:
    request = folder / "request.json"
    if request.exists():
        name, arguments = json.loads(request.read_text())
        request.unlink()
        try:
            step = next(vars(module)[name] for module in steps if name in vars(module))
            answer = {"result": step(**arguments)}
        except BaseException:
            answer = {"error": traceback.format_exc()}
        (folder / "answer.new").write_text(json.dumps(answer))
        os.replace(folder / "answer.new", folder / "answer.json")
    return POLL_SECONDS


bpy.context.preferences.use_preferences_save = False
bpy.app.timers.register(poll, persistent=True)
