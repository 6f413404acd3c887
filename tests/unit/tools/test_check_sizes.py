# SPDX-License-Identifier: GPL-3.0-or-later
"""Files, folders and classes that are too large are found."""

from tools.check_sizes import MAX_ATTRIBUTES, MAX_FILES, MAX_LINES, large_classes, problems


def class_with(fields, assigned):
    lines = [f"    field{number}: int = 0" for number in range(fields)]
    lines += ["    def __init__(self):", "        self.field0 = 1"]
    lines += [f"        self.value{number} = 0" for number in range(assigned)]
    return "\n".join(["class Record:", *lines, ""])


def test_attributes_count_once_wherever_they_are_declared():
    assert large_classes(class_with(MAX_ATTRIBUTES - 3, 3)) == []
    assert large_classes(class_with(MAX_ATTRIBUTES - 3, 4)) == [(1, "Record", MAX_ATTRIBUTES + 1)]
    assert large_classes(class_with(1, MAX_ATTRIBUTES).replace("Record", "RenderSettings")) == []


def test_long_files_and_full_folders(tmp_path):
    folder = tmp_path / "rppm_addon" / "room"
    folder.mkdir(parents=True)
    for number in range(MAX_FILES):
        (folder / f"module{number}.py").write_text("\n" * (MAX_LINES if number else 1))
    assert problems(tmp_path) == []
    (folder / "one_more.py").write_text("\n" * (MAX_LINES + 1))
    assert [text.partition(":")[0] for text in problems(tmp_path)] == ["rppm_addon/room", "rppm_addon/room/one_more.py"]
