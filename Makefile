# make setup   .venv with timemap in it
# make demo    the main job on the sample recordings: replay, then diff
# make test    the tests, in random order (RANDOM_SEED=N repeats one)
# make check   ruff, mypy, import-linter, deptry
# make bench   how fast a replay is beside plain reading
# make changes-bench  how well changes are told where they are known
# make forward-bench  how many scans of a robot that drives forward are lost, and what the others claim
# make lost-bench  what the guard sets aside: of robots that are lost, and of those that are not
# make damage  what becomes of recordings that are damaged at random
# make kill-bench  replays stopped at random moments, by kill -9 and otherwise: nothing earlier is lost
# make mutations  which mistakes timemap check catches, and whether noise alone passes
# make paper   the paper's experiments: docs/paper.md and its figures
# make clean   remove what the above made, except .venv

VENV := .venv
BIN := $(VENV)/bin
BUILD := build
SAMPLES := sample_logs/patrol_monday.mcap sample_logs/patrol_tuesday.bag sample_logs/patrol_thursday

# The versions in constraints.txt hold for the tools that build the package, too.
PIP_INSTALL := PIP_CONSTRAINT=constraints.txt PIP_DISABLE_PIP_VERSION_CHECK=1 $(BIN)/python -m pip install --quiet

.PHONY: setup demo test check bench changes-bench forward-bench lost-bench damage kill-bench mutations paper clean
.DELETE_ON_ERROR:

setup: $(VENV)/timemap.stamp

demo: $(VENV)/timemap.stamp
	@mkdir -p $(BUILD)
	$(BIN)/timemap replay $(SAMPLES) -o $(BUILD)/demo.timemap.mcap --force
	@echo
	$(BIN)/timemap diff $(BUILD)/demo.timemap.mcap --level long mid

test: $(VENV)/dev.stamp
	$(BIN)/python -m pytest -q -rs -n auto --dist loadfile $(if $(RANDOM_SEED),--randomly-seed=$(RANDOM_SEED))

check: $(VENV)/dev.stamp
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache
	$(BIN)/deptry timemap_cli
	$(BIN)/deptry tests sample_logs benchmarks --exclude '\.venv' --ignore DEP002,DEP004

bench: $(VENV)/timemap.stamp
	$(BIN)/python benchmarks/replay_hour.py

changes-bench: $(VENV)/timemap.stamp
	$(BIN)/python -m benchmarks.changes --again

forward-bench: $(VENV)/timemap.stamp
	$(BIN)/python -m benchmarks.forward

lost-bench: $(VENV)/timemap.stamp
	$(BIN)/python -m benchmarks.lost $(LOGS)

damage: $(VENV)/timemap.stamp
	$(BIN)/python -m benchmarks.damage

mutations: $(VENV)/timemap.stamp
	$(BIN)/python -m benchmarks.mutations

kill-bench: $(VENV)/timemap.stamp
	$(BIN)/python -m benchmarks.stopped_replays

paper: $(VENV)/paper.stamp
	$(BIN)/python -m benchmarks.paper

clean:
	rm -rf $(BUILD) .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache *.egg-info
	find timemap_cli tests sample_logs benchmarks -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/timemap.stamp: pyproject.toml constraints.txt $(BIN)/python
	$(PIP_INSTALL) -e .
	@touch $@

$(VENV)/dev.stamp: $(VENV)/timemap.stamp
	$(PIP_INSTALL) -e '.[dev]'
	@touch $@

$(VENV)/paper.stamp: $(VENV)/timemap.stamp
	$(PIP_INSTALL) -e '.[paper]'
	@touch $@

# The first Python on the path that is new enough and can make an environment with pip in it.
$(BIN)/python:
	@for python in python3 python3.13 python3.12 python3.11 python3.14 python; do \
	  if $$python -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then \
	    echo "$$python -m venv $(VENV)"; exec $$python -m venv $(VENV); \
	  fi; \
	done; \
	echo 'error: no Python 3.11 or newer with the modules venv and ensurepip was found' >&2; \
	echo '  try: apt-get install python3-venv' >&2; \
	exit 1
