# `make` sets up, `make run` runs the nominal machine cycle, `make test` runs what CI runs.

# How many times faster than the machine the cycle is played.
RATE ?= 1
# More arguments for pytest, such as ARGS='test/surrogate -k hertz'.
ARGS ?=

# Another ROS or another environment must not reach into this one.
unexport _ROS_WHEELS_BOOTSTRAP_COMPLETE LD_LIBRARY_PATH PYTHONPATH PYTHONHOME VIRTUAL_ENV
unexport AMENT_PREFIX_PATH CMAKE_PREFIX_PATH COLCON_PREFIX_PATH RMW_IMPLEMENTATION

.PHONY: set-up run test format bench docs fresh-test clean help

set-up:
	@sh scripts/set_up.sh

run: set-up
	@exec .venv/bin/ballscrew run --rate $(RATE) --out out

test: set-up
	@exec sh scripts/test.sh $(ARGS)

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
	@echo 'make test       the checks and the tests; ARGS is handed to pytest'
	@echo '                ARGS="-m fast" leaves out what takes long'
	@echo 'make format     put imports and code in the form that the checks ask for'
	@echo 'make bench      measure solver, lookup and node, in under two minutes'
	@echo 'make docs       write pages of the API from the docstrings into build/api/'
	@echo 'make fresh-test clone the last commit and run both there'
	@echo 'make clean      remove everything that is made'
	@echo 'PYTHON=python3.12 chooses the Python that .venv is made of'
