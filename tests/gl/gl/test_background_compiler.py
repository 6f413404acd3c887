# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs that are compiled on other cores until somebody runs them."""

import threading
import time
from types import SimpleNamespace

import pytest

from rppm_addon.gl.programs import background_compiler
from rppm_addon.gl.programs.background_compiler import BackgroundCompiler, EmptyDispatch
from rppm_addon.gl.programs.sources import Source


class Driver:
    """Contexts that open once ``ready`` is set and note what they compile."""

    def __init__(self):
        self.ready = threading.Event()
        self.compiled = []
        self.done = threading.Semaphore(0)

    def open(self):
        assert self.ready.wait(60.0)
        return SimpleNamespace(compile=self._compile, release=lambda: None)

    def wait_for(self, count):
        for _ in range(count):
            assert self.done.acquire(timeout=60.0)

    def _compile(self, source):
        if source.text == "wrong":
            raise ValueError(source.text)
        self.compiled.append(source.text)
        self.done.release()


@pytest.fixture
def driver(monkeypatch):
    monkeypatch.setattr(background_compiler, "usable_cores", lambda: 2)
    return Driver()


def sources(*texts):
    return [Source(text, [text]) for text in texts]


def submit_alone(compiler, source):
    """And wait until the thread has taken it."""
    compiler.submit(source)
    while compiler._waiting:
        time.sleep(0.001)


def test_the_longest_that_nobody_has_claimed_is_next(driver):
    compiler = BackgroundCompiler(driver.open)
    first, short, long, claimed = sources("first", "a", "aaa", "aaaaa")
    submit_alone(compiler, first)
    for source in (short, long, claimed):
        compiler.submit(source)
    compiler.claim(claimed)  # of those that wait: returns at once
    driver.ready.set()
    compiler.claim(first)  # while it is being compiled: returns when it is done
    assert driver.compiled[0] == "first"
    driver.wait_for(3)
    assert driver.compiled == ["first", "aaa", "a"]


def test_what_pictures_need_comes_before_what_has_a_stand_in(driver):
    compiler = BackgroundCompiler(driver.open)
    first, needed, longer = sources("first", "aa", "aaaa")
    submit_alone(compiler, first)
    compiler.submit(longer, needed=False)
    compiler.submit(needed)
    assert compiler.knows(longer) and not compiler.has_tried(longer)
    driver.ready.set()
    driver.wait_for(3)
    compiler.claim(longer)
    assert driver.compiled == ["first", "aa", "aaaa"] and compiler.has_tried(longer)
    compiler.submit(longer)  # is there
    assert compiler.knows(longer) and not compiler._waiting


def test_what_nobody_waits_for_has_one_thread(driver, monkeypatch):
    monkeypatch.setattr(background_compiler, "usable_cores", lambda: 8)
    compiler = BackgroundCompiler(driver.open)
    compiler.hurry(False)
    for source in sources("a", "aa", "aaa"):
        compiler.submit(source)
    assert compiler._threads == {True: 0, False: 1}
    compiler.hurry(True)
    assert compiler._threads == {True: 1, False: 1}
    driver.ready.set()
    driver.wait_for(3)


def test_what_fails_is_left_to_whoever_runs_it(driver):
    compiler = BackgroundCompiler(driver.open)
    wrong, right = sources("wrong", "right")
    compiler.submit(wrong)
    compiler.submit(right)
    driver.ready.set()
    compiler.claim(wrong)
    compiler.claim(right)
    assert compiler.has_tried(wrong)
    closed = BackgroundCompiler(lambda: 1 / 0)  # a device that does not open
    closed.submit(right)
    closed.claim(right)


def test_what_is_stopped_begins_no_other(driver):
    compiler = BackgroundCompiler(driver.open)
    first, second = sources("first", "second")
    submit_alone(compiler, first)
    compiler.submit(second)
    compiler.stop()
    driver.ready.set()
    compiler.claim(first)
    compiler.claim(second)
    assert driver.compiled == ["first"]


def test_an_empty_dispatch_writes_nothing(context):
    program = context.moderngl.compute_shader(
        "#version 430 core\nlayout(local_size_x = 1) in;\n"
        "layout(std430, binding = 0) buffer Values { uint values[]; };\nvoid main() { values[0] = 7u; }\n"
    )
    values = context.moderngl.buffer(bytes(4))
    values.bind_to_storage_buffer(0)
    dispatch = EmptyDispatch(context)
    dispatch.run(program.glo)
    assert values.read() == bytes(4)
    program.run(1)
    assert values.read() == b"\x07\0\0\0"
    for item in (dispatch, program, values):
        item.release()
