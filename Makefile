# SPDX-License-Identifier: GPL-3.0-or-later
.DEFAULT_GOAL := help
.PHONY: help setup render sample extension test test-unit test-long test-touched fuzz coverage test-gui test-wheels soak lock format lint docs docs-tools docs-version docs-images pairs survey combined references parity bench bench-tools bench-export bench-peers drivers clean
# Where an environment forbids compiled modules, each of the hundreds of processes of the tests compiles them anew.
unexport PYTHONDONTWRITEBYTECODE
RPPM = .venv/bin/rppm
BLENDER_PYTHON = .venv/bin/python
SCENES ?= ../shared/scenes
RESOLUTION ?= 256x192
SECONDS_EACH ?= 60

help: ## Show this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-12s %s\n", $$1, $$2 }' Makefile

setup: ## Install what is missing: system packages (Debian, as root), .venv and a newer Mesa
	@.ci/set_up.sh

render: setup ## Render the sample scene inside Blender with RPPM to out/ (PNG and EXR)
	$(RPPM) render docs/samples/first_light.blend -o out/first_light.exr -o out/first_light.png --json out/first_light.json

sample: setup ## Build docs/samples/*.blend anew
	for name in first_light pool spotlight caustics_over_cycles; do \
		$(BLENDER_PYTHON) docs/samples/$$name.py docs/samples/$$name.blend || exit 1; done

extension: setup ## Build the zip that Blender installs, to build/extension/ (EXTENSION=--split-platforms: one a platform)
	.venv/bin/python extension/build.py $(EXTENSION)

# Each of their tests compiles programs and renders next to nothing, which the system's older Mesa does in a third of
# the time while nothing is cached.
COMPILE_BOUND = tests/parity/features tests/parity/nodes \
	tests/blender/export/shading/test_bad_materials.py tests/blender/export/shading/test_material_fuzz.py \
	tests/blender/engine/test_animation.py tests/blender/engine/test_animations.py \
	tests/gl/materials/test_material_programs.py tests/gl/gl/test_gl_layer.py \
	tests/gl/surfaces/test_adjoint_bsdf.py tests/gl/surfaces/test_displacement.py tests/gl/surfaces/test_hair.py \
	tests/gl/device_scene/test_large_buffers.py
# Three at a time also on two cores: most tests compile or render on a single core, and some wait for processes.
PYTEST = timeout --kill-after=10 4500 .venv/bin/python -m pytest --numprocesses=3 --dist=worksteal

test: setup ## Run the tests, but for those that take long
	RPPM_MESA=system $(PYTEST) -m 'not long' $(COMPILE_BOUND)
	$(PYTEST) -m 'not long' $(COMPILE_BOUND:%=--ignore=%)

test-unit: ## Run what needs neither OpenGL nor Blender
	.venv/bin/python -m pytest -q tests/unit

test-long: setup ## Run the tests that take long
	$(PYTEST) -m long

test-touched: setup ## Run of the tests that take long what changed files ask for (SINCE=commit)
	files="$$(.venv/bin/python tools/touched_tests.py $(SINCE))" && if [ -n "$$files" ]; then \
		$(PYTEST) -m long $$files || [ $$? -eq 5 ]; else echo "no long tests are asked for"; fi

MINUTES ?= 10
fuzz: setup ## Give every way in what nobody means (MINUTES=10), and count
	.venv/bin/python tools/fuzz.py $(MINUTES) $(SEED)

coverage: setup ## Report which lines tests/unit, gl, session and cli reach (TESTS=...: others)
	$(PYTEST) -m 'not long' --cov --cov-report=term $(or $(TESTS),tests/unit tests/gl tests/session tests/cli)

# Its tests ask the window to answer soon: no other may be beside it.
WINDOW_ALONE = tests/gui/test_window_response.py
PYTEST_GUI = timeout --kill-after=10 2400 .venv/bin/python -m pytest -m 'not long'

test-gui: setup ## Run the tests in a real Blender window, Debian's in a chroot (once: 3 minutes, 1.4 GB in ~/.cache/rppm-gui)
	$(PYTEST_GUI) $(WINDOW_ALONE)
	$(PYTEST_GUI) --numprocesses=3 --dist=worksteal tests/gui $(WINDOW_ALONE:%=--ignore=%)

test-wheels: setup ## Install the zip in each Blender that it claims and use it (once: 5 GB in ~/.cache/rppm-wheels)
	timeout --kill-after=10 3600 .venv/bin/python -m pytest tests/versions

HOURS ?= 2
soak: setup ## Use a real Blender window for long (HOURS=2), and tell what grew, or was another picture: out/soak/
	.venv/bin/python tools/soak.py $$(awk 'BEGIN { print 60 * $(HOURS) }')

lock: setup ## Pin anew what make installs, by version and hash
	.venv/bin/python tools/lock.py

# The shaders of the package, and those of tests.
SHADERS = $(shell find shaders tests -name '*.glsl' -o -name '*.comp' -o -name '*.vert' -o -name '*.frag')

format: setup ## Lay out Python and GLSL
	.venv/bin/ruff format .
	@.venv/bin/clang-format -i $(SHADERS)

lint: setup ## Check layout, Python, types, imports, license lines, shaders, pinned packages, and what bandit finds unsafe
	.venv/bin/ruff format --check .
	@.venv/bin/clang-format --dry-run --Werror $(SHADERS)
	.venv/bin/ruff check .
	.venv/bin/python tools/check_docstrings.py
	.venv/bin/python tools/check_sizes.py
	.venv/bin/mypy
	.venv/bin/lint-imports --no-cache
	.venv/bin/reuse lint --lines
	.venv/bin/python tools/check_shaders.py
	.venv/bin/python tools/lock.py --check
	.venv/bin/bandit --quiet --recursive --configfile pyproject.toml rppm_addon extension tools .ci setup.py

docs-tools: setup
	@.venv/bin/python .ci/install_locked.py docs

docs: docs-tools ## Build the documents as a site, build/site/index.html, and check their links
	NO_MKDOCS_2_WARNING=1 .venv/bin/python -m mkdocs build --quiet --config-file tools/site/mkdocs.yml
	@echo build/site/index.html

VERSION ?= $(shell awk -F '"' '/^version/ { print $$2 }' blender_manifest.toml)
docs-version: docs-tools ## Keep the site of this version beside those of others, on the branch gh-pages (VERSION=0.1.0)
	NO_MKDOCS_2_WARNING=1 .venv/bin/mike --quiet deploy --config-file tools/site/mkdocs.yml --update-aliases $(VERSION) latest
	.venv/bin/mike set-default --config-file tools/site/mkdocs.yml latest

docs-images: setup ## Render the pictures of the pages, SECONDS_EACH of the processor for each engine (GALLERY="--only prism --again")
	.venv/bin/python tools/gallery/render.py --seconds $(SECONDS_EACH) $(GALLERY)
	.venv/bin/python tools/gallery/render.py --films $(GALLERY)
	.venv/bin/python tools/setting_pairs.py

pairs: setup ## Compare the .blend files of SCENES with Cycles, to out/pairs/ (PAIRS=name: some; done ones are kept)
	.venv/bin/python -m tools.pairs $(SCENES) --resolution $(RESOLUTION) --seconds $(SECONDS_EACH) $(PAIRS)

survey: setup ## Compare small files as beginners make them with Cycles, to out/survey/ (PAIRS=name: some; done ones are kept)
	.venv/bin/python -m tools.beginner_files out/survey/files
	.venv/bin/python -m tools.pairs out/survey/files --out out/survey --samples 32 --cycles-samples 64 $(PAIRS)

SEEDS ?= 0-7
combined: setup ## Compare random files that combine features with Cycles, to out/combined/ (SEEDS=0-7; PAIRS=name: some; done ones are kept)
	.venv/bin/python -m tools.combined_files out/combined/files --seeds $(SEEDS)
	.venv/bin/python -m tools.pairs out/combined/files --out out/combined --samples 64 --cycles-samples 256 $(PAIRS)

TESTS ?= tests/parity
references: setup ## Keep what Cycles gives for the parity tests in tests/parity/references/ (TESTS=tests/parity/lights/test_lights.py)
	.venv/bin/python -m pytest -q $(TESTS) --cycles=write --timeout=3600

parity: setup ## Compare references with Cycles, and each feature (ROWS=--continue): out/parity/, docs/compatibility.md
	.venv/bin/python -m pytest -q $(TESTS) --cycles=compare --timeout=3600
	.venv/bin/python -m tests.parity.features.report $(ROWS)

bench-tools: setup
	@.venv/bin/python .ci/install_locked.py bench

bench: bench-tools ## Measure deep cubemap and estimator for docs/benchmarks/ (BENCH=--quick: to out/benchmarks/)
	.venv/bin/python -m benchmarks.device.run --scene-folder $(SCENES) $(BENCH)
	.venv/bin/python -m benchmarks.frame_costs --output out/benchmarks/frame_costs.json $(filter --quick,$(BENCH))

bench-export: setup ## Measure what a frame costs in which everything moves (BENCH=--quick)
	.venv/bin/python -m benchmarks.export.speed --output out/benchmarks/export.json $(BENCH)

bench-peers: bench-tools ## Compare with Cycles, LuxCore and Mitsuba at equal time, to out/peers/ (BENCH=--quick, --plain, --files, --publish)
	.venv/bin/python -m benchmarks.peers.run $(BENCH)

drivers: setup ## Compile all programs on drivers of GPUs that are not there (DRIVERS=--quick: three of them, what changed)
	.venv/bin/python -m benchmarks.drivers.run $(DRIVERS)

clean: ## Remove what was made: out/, caches (.venv and .mesa stay)
	rm -rf out .gl .pytest_cache .hypothesis .ruff_cache .mypy_cache .import_linter_cache build *.egg-info
	find . -name ".?*" -prune -o -name __pycache__ -type d -prune -exec rm -rf {} +
