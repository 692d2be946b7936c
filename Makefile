# `make` sets up, `make run` runs the nominal machine cycle, `make test` runs what CI runs.

# How many times faster than the machine the cycle is played.
RATE ?= 1
# More arguments for pytest, such as ARGS='test/surrogate -k hertz'.
ARGS ?=
# How long `make fuzz` goes on [min].
MINUTES ?= 10
# How many mutants `make mutate` tries, and which of them.
SAMPLE ?= 100
SEED ?= 1

# Another ROS or another environment must not reach into this one.
unexport _ROS_WHEELS_BOOTSTRAP_COMPLETE LD_LIBRARY_PATH PYTHONPATH PYTHONHOME VIRTUAL_ENV
unexport AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH RMW_IMPLEMENTATION

.PHONY: set-up run page test fuzz mutate format bench docs fresh-test clean help

set-up:
	@sh scripts/set_up.sh

run: set-up
	@exec .venv/bin/ballscrew run --rate $(RATE) --out out

page: set-up
	@exec sh scripts/page.sh $(ARGS)

test: set-up
	@sh scripts/browser.sh
	@exec sh scripts/test.sh $(ARGS)

fuzz: set-up
	@exec sh scripts/fuzz.sh $(MINUTES) $(ARGS)

mutate: set-up
	@exec .venv/bin/python scripts/mutate.py --sample $(SAMPLE) --seed $(SEED) $(ARGS)

format: set-up
	@.venv/bin/ruff check --quiet --fix-only
	@.venv/bin/ruff format --quiet

bench: set-up
	@for file in bench/*.py; do echo "== $$file"; .venv/bin/python $$file || exit; done

docs: set-up
	@.venv/bin/pdoc --no-show-source --output-directory build/api ballscrew_monitor surrogate
	@echo 'API pages: build/api/index.html'

fresh-test:
	@exec sh scripts/fresh_test.sh

clean:
	rm -rf .venv build install log out bags/nominal_cycle *.egg-info
	rm -rf .hypothesis .mypy_cache .pytest_cache .ruff_cache .benchmarks
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

help:
	@echo 'make            set everything up in .venv; a second call finds it done'
	@echo 'make run        play the nominal machine cycle to the node; results in out/'
	@echo '                RATE=4 plays four times faster'
	@echo 'make page       play that cycle in a loop and serve a live page of it, until Ctrl-C'
	@echo '                ARGS is handed to `ballscrew page`'
	@echo 'make test       the checks and the tests; ARGS is handed to pytest'
	@echo '                ARGS="-m fast" leaves out what takes long'
	@echo 'make fuzz       the properties among the tests with random draws, round after round'
	@echo '                MINUTES=60 goes on for an hour instead of 10 min'
	@echo 'make mutate     change the sources in a sample of places and ask which test notices'
	@echo '                SAMPLE=300 tries more places, SEED=2 others, ARGS names files; Ctrl-C and'
	@echo '                a second call goes on. ARGS=--matrix asks which tests notice what alone'
	@echo 'make format     put imports and code in the form that the checks ask for'
	@echo 'make bench      measure solver, lookup, node and health, in some minutes'
	@echo 'make docs       write pages of the API from the docstrings into build/api/'
	@echo 'make fresh-test clone the last commit and run both there'
	@echo 'make clean      remove everything that is made'
	@echo 'PYTHON=python3.12 chooses the Python that .venv is made of'
