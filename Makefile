# What people do with this folder. On Debian and Ubuntu every command first brings what is missing.
#
#   PROFILE=folder   keep QGIS's settings and the plugin there instead of in your own profile
#   TILE=path.laz    let "make demo" look for buildings in your own tile
#   MINUTES=5 SEED=7 KINDS="laz vpc" how long "make fuzz" looks (5), with which damage (another one each time), at what
#   GUIDED=1         let "make fuzz" choose the damage by the lines that it reaches, which needs atheris
#   SIZES="0.1 1 10" million points that "make bench" measures (0.1 1); STAGES="…" only these stages; CLOUD=tile.laz a cloud of yours

.DEFAULT_GOAL := help
SHELL := /bin/bash

# Debian's QGIS runs the system's Python, whatever python3 comes first on PATH.
PYTHON := /usr/bin/python3
VENV := .venv
# A file of tests stays in one process, which makes what its tests share but once.
ON_ALL_CORES := -n auto --dist loadfile --no-loadscope-reorder
# An interpreter without QGIS will do: numpy, scipy, scikit-learn, laspy and those of OF_TESTS.
CORE_PYTHON := $(VENV)/bin/python
CORE_TESTS := tests/algorithms tests/test_contract.py algorithms
OF_TESTS := 'lazrs>=0.6,<0.9' 'pytest>=8,<10' 'pytest-xdist>=3.5,<4' 'hypothesis==6.*' 'zstandard>=0.20,<1' 'pyproj>=3.4'

# Collecting the tests takes three times as long where they are not kept compiled.
export PYTHONDONTWRITEBYTECODE :=

ifdef PROFILE
export QGIS_CUSTOM_CONFIG_PATH := $(abspath $(PROFILE))
endif

ifneq ($(filter-out root,$(SUDO_USER)),)

# Under "sudo make" only the system's packages are root's business: the rest goes on as the user who asked.
Makefile: ;
%:
	scripts/install.sh system
	sudo -u $(SUDO_USER) -H $(MAKE) $@ $(MAKEOVERRIDES)

else

.PHONY: help install new-stage pictures demo test test-slow test-all test-core test-pythons test-qgis check lint bench fuzz docs package clean

help: ## this list
	@sed -n 's/^\([a-z-]*\):.* ## /  make \1\t/p' Makefile | expand -t 18

install: ## QGIS, the Python packages and the plugin, where they are missing
	@scripts/install.sh

demo: install ## find the buildings of a simulated town, or of TILE, and draw them (in demo/)
	@scripts/offscreen.sh $(PYTHON) scripts/demo.py $(if $(TILE),"$(TILE)")

test: install $(VENV)/made lint docs ## check the code, build the documentation, then run every test but the slow ones, on all cores
	@scripts/offscreen.sh $(VENV)/bin/python -m pytest $(ON_ALL_CORES) -m "not slow"

test-slow: install $(VENV)/made ## the slow tests: more real clouds, more draws, the scanners of the plugin repository
	@scripts/offscreen.sh $(VENV)/bin/python -m pytest $(ON_ALL_CORES) -m slow

test-all: test test-slow ## every test

test-core: ## the tests of the core with CORE_PYTHON, which needs no QGIS but requirements-dev.txt and what those name
	@$(CORE_PYTHON) -m pytest -p no:pytest_qgis $(ON_ALL_CORES) $(CORE_TESTS)

test-pythons: ## the tests of the core with the oldest and the newest Python and numpy, in Debian's own builds (in .pythons)
	@scripts/other_python.sh bullseye 3.9 .pythons 'numpy==1.24.*' 'scipy==1.10.*' 'scikit-learn==1.2.*' 'laspy==2.5.*' $(OF_TESTS) -- -n auto $(CORE_TESTS)
	@scripts/other_python.sh trixie 3.13 .pythons 'numpy>=2' scipy scikit-learn 'laspy<3' 'pysfcgal==2.3.*' $(OF_TESTS) -- -n auto $(CORE_TESTS)

test-qgis: ## the tests of the plugin with QGIS 3.44, in a Debian system of its own (in .pythons; asks for root)
	@scripts/other_qgis.sh trixie .pythons $(ON_ALL_CORES) -m "not slow" tests/provider tests/test_package.py

check: $(VENV)/made ## what changed since main, in half a minute: ruff, mypy, the tests of the modules and their contract
	@$(VENV)/bin/python scripts/check.py

lint: $(VENV)/made ## ruff, mypy, spelling, and words that make text hard to read
	@$(VENV)/bin/ruff check .
	@$(VENV)/bin/ruff format --check --quiet .
	@$(VENV)/bin/mypy
	@$(PYTHON) scripts/words.py
	@$(VENV)/bin/codespell algorithms provider tests scripts docs *.md *.txt *.toml Makefile
	@$(PYTHON) scripts/metadata.py --check
	@$(PYTHON) scripts/measured_tables.py --check

bench: install $(VENV)/made ## time and memory of every stage (a table, and benchmarks/times.json)
	@scripts/offscreen.sh $(VENV)/bin/python tests/benchmarks/benchmark.py $(if $(SIZES),--sizes $(SIZES)) $(if $(STAGES),--stages $(STAGES)) $(if $(CLOUD),--cloud "$(abspath $(CLOUD))")

fuzz: $(VENV)/made ## read damaged files for MINUTES, with the damage of SEED (findings in benchmarks/fuzz)
	@$(VENV)/bin/python tests/attacks/fuzz.py $(if $(MINUTES),--minutes $(MINUTES)) $(if $(SEED),--seed $(SEED)) \
		$(if $(KINDS),--kinds $(KINDS)) $(if $(GUIDED),--guided)

new-stage: ## begin a stage, NAME=room.verb_object: a module and a test that run, to be edited
	@$(PYTHON) scripts/new_stage.py "$(NAME)"

pictures: $(VENV)/made ## draw the pictures of the help pages anew, or those of IDS
	@scripts/offscreen.sh $(VENV)/bin/python scripts/help_pictures.py $(IDS)
	@$(if $(IDS),,scripts/offscreen.sh $(VENV)/bin/python scripts/hough_picture.py)

docs: $(VENV)/made ## the documentation (in docs/_build/html), with warnings as errors
	@$(VENV)/bin/python -m sphinx -b html -q -W --keep-going docs docs/_build/html

package: $(VENV)/made ## the zip for QGIS's plugin repository (in dist/), scanned as that scans it
	@$(PYTHON) scripts/metadata.py
	@$(PYTHON) scripts/package.py
	@$(VENV)/bin/python scripts/scan.py dist/*-$$(sed -n 's/^version=//p' metadata.txt).zip

clean: ## remove what these commands made in this folder
	rm -rf $(VENV) .pythons demo dist benchmarks docs/_build docs/gallery docs/methods/generated docs/reference/generated tests/benchmarks/.cache .hypothesis .mypy_cache .pytest_cache .ruff_cache .qgis-settings
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# The system's packages show through, so that the tests run on the numpy and the QGIS that users have.
$(VENV)/made: requirements.txt requirements-dev.txt requirements-docs.txt
	$(PYTHON) -m venv --system-site-packages $(VENV)
	$(VENV)/bin/python -m pip install --quiet -r requirements-dev.txt
	@touch $@

endif
