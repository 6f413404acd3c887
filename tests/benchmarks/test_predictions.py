# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders that count what they ask of memory, and what follows from it."""

import numpy as np
import pytest

from benchmarks.predictions.counting import Site, counted
from benchmarks.predictions.model import Demand, Gpu, Line, demands
from benchmarks.predictions.recorder import Asked, Recorder
from rppm_addon.gl.context.context import Context
from rppm_addon.gl.programs import sources
from rppm_addon.gl.programs.programs import ProgramLibrary

SHADER = """#version 430 core
layout(local_size_x = 64) in;
struct Item { vec3 place; uint next; };
readonly buffer Items { Item items[]; };
buffer Results { uint total; uint results[]; };
void main() {
    uint index = gl_GlobalInvocationID.x;  // results[index]
    if (index >= 100u) return;
    Item item = items[items[index].next];
    if (index < 10u) atomicAdd(total, item.next);
    results[index] += uint(item.place.x);
    atomicMax(results[index % 5u], 0u);
}
"""
COUNTS = {
    Site("read", "Items", 4): 100,  # a member by itself
    Site("read", "Items", 16): 100,
    Site("counter", "Results", 4): 10,
    Site("read", "Results", 4): 100,
    Site("write", "Results", 4): 100,
    Site("atomic", "Results", 4): 100,
}


def test_sites_of_a_shader():
    text, sites = counted(SHADER, 7)
    assert set(sites) == {Site("invocations"), *COUNTS}
    assert "items[counted_item_" in text and "imageAtomicAdd(access_counts, 7, counted_0)" in text


def test_arrays_within_items_count():
    text = """#version 430 core
struct Part { vec3 color; uint kind; };
struct Whole { vec2 place; Part parts[3]; };
buffer Wholes { Whole wholes[]; };
void main() {
    int k = int(wholes[2].place.x);
    Whole whole = wholes[0];
    Part part = wholes[1].parts[k + 1];
    wholes[1].parts[k].color = part.color + whole.parts[0].color;
}
"""
    sizes = [Site("read", "Wholes", size) for size in (4, 56, 16)]
    assert counted(text, 0)[1] == [Site("invocations"), *sizes, Site("write", "Wholes", 12)]


def test_programs_count_what_they_ask(tmp_path, monkeypatch):
    monkeypatch.setenv("RPPM_CACHE", str(tmp_path))
    monkeypatch.setattr(sources, "SHADER_FOLDER", tmp_path)
    (tmp_path / "shader.comp").write_text(SHADER)
    context = Context.create()
    recorder = Recorder(context)
    items = np.zeros(100, np.dtype([("place", "f4", 3), ("next", "u4")]))
    items["place"], items["next"] = 3.0, np.arange(100)[::-1]
    buffers = {"Items": context.moderngl.buffer(items.tobytes()), "Results": context.moderngl.buffer(reserve=404)}
    with recorder.recording():
        program = ProgramLibrary(context).compute("shader.comp")
        for _ in range(2):
            recorder.reset()
            buffers["Results"].clear()
            program.run(100, buffers)
    asked = recorder.read()["shader.comp"]
    assert (asked.runs, asked.invocations, asked.sizes) == (1, 128, {"Items": 1600, "Results": 404})
    assert asked.asked == COUNTS
    results = np.frombuffer(buffers["Results"].read(), np.uint32)
    assert results[0] == sum(range(10)) and np.all(results[1:] == 3)
    context.release()


def test_demands_by_pixels():
    # Reads four times what there is, and a counter that grows with the pixels.
    found = [
        {"a": Asked(2, 2 * n, {Site("read", "B", 16): 8 * n, Site("counter", "C"): 2 * n}, {"B": 16 * n, "C": 4})}
        for n in (100, 300)
    ]
    demand = demands((100, 300), found, iterations=2)["a"]
    assert demand.runs == 1.0 and demand.threads.at(1000) == pytest.approx(1000)
    assert demand.asked.at(1000) == pytest.approx(64000) and demand.least.at(1000) == pytest.approx(16000)
    gpu = Gpu("G", "G", 1e9, 1e6, 10, 32, 32, "")
    assert demand.seconds(gpu, 1000) == pytest.approx(max(16000 / 1e9, 1000 / 32 / 1e6))
    assert demand.waiting_seconds(gpu, 1000, 16, 32) > demand.seconds(gpu, 1000) + 1000 / 1e6
    assert Demand.of(demand.as_dict()) == demand


def test_lines_have_no_negative_parts():
    assert Line.through((1, 2), (5.0, 5.0)) == Line(5.0, 0.0)
    assert Line.through((1, 3), (1.0, 7.0)).base == 0.0 and Line.through((1, 3), (7.0, 1.0)) == Line(4.0, 0.0)
