# Every target runs in the checkout's own virtual environment, which environment.py sets up once.
PYTHON ?= python3
JOBS ?= 2
LANES ?= 2
UPDATES ?= 1
BOARD ?= ulx3s-85f

# Keep this make's flags from the makes that Verilator and cocotb start.
run := env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL AMARANTH_USE_YOSYS=builtin .venv/bin/python
lower = $(shell echo $(1) | tr A-Z a-z)
option = --$(call lower,$(1)) $($(1))
# The sizes of a circuit (hw/sizes.py). A board has sizes of its own; those given on the command line replace them.
SIZES := LANES UPDATES NODES EDGES MATERIALS TABLES AXES
sizes := $(foreach size,$(SIZES),$(if $($(size)),$(call option,$(size))))
given := $(foreach size,$(SIZES),$(if $(filter-out undefined file,$(origin $(size))),$(call option,$(size))))
family := $(if $(FAMILY),--family $(FAMILY))
# All tests of a file go to one worker, so that what they share is built once.
pytest := $(run) -m pytest -n $(JOBS) --dist loadfile --durations 10

.DEFAULT_GOAL := compare
.NOTPARALLEL:
.PHONY: compare figures verilog timing bitstream flash doctor bench test verify lint lock help clean distclean environment

compare: verilog ## the default: emit the Verilog, run all shipped scenes on float64, integers and the simulated circuit
	@$(run) -m sim compare scenes/*.toml --lanes $(LANES) --updates $(UPDATES) --out build/report
	@echo "report: build/report/index.html, figures: build/report/compare.json"

figures: environment ## draw the paper's figures from runs of the circuit: PNG, SVG, GIF and their numbers in build/figures
	@$(run) -m sim figures --out build/figures

verilog: environment ## write the circuit's Verilog below build/; LANES=, UPDATES=, NODES=, EDGES=, MATERIALS=, TABLES=, AXES= set its size, FAMILY= its hard blocks
	@$(run) -m hw verilog $(sizes) $(family) --out build/verilog

timing: environment ## place and route for BOARD=, a file below constraints/, and report clock and use; LANES= ... as above, SEEDS="1 2 3", JOBS=, KEEP=1 publishes
	@$(run) -m hw timing --board $(BOARD) $(given) \
	    $(if $(SEEDS),--seeds $(SEEDS)) --jobs $(JOBS) $(if $(KEEP),--keep)

bitstream: environment ## build the bitstream for BOARD=, or a project for its vendor's tool; LANES= ... as above, KEEP=1 publishes
	@$(run) -m hw bitstream --board $(BOARD) $(given) \
	    $(if $(KEEP),--keep)

flash: environment ## load the bitstream into BOARD=; PERMANENT=1 into its flash, for every power-on
	@$(run) -m hw flash --board $(BOARD) $(if $(PERMANENT),--permanent)

doctor: environment ## list tools, packages, boards and ports; say what is missing and what to do
	@$(run) -m hw doctor

bench: environment ## time a step of the circuit and of software on this machine, which must be idle meanwhile
	@$(run) -m sim bench --out build/bench.json

test: environment ## run the tests
	@$(pytest) -m "not campaign"

verify: environment ## run the tests and the long campaigns of the published figures
	@$(pytest)

lint: environment ## check the style of all Python files
	@$(run) -m ruff check --quiet .
	@$(run) -m ruff format --check --quiet .

lock: ## resolve the pins of pyproject.toml again and write requirements.lock
	@$(PYTHON) environment.py --lock

help: ## print this list
	@sed -n 's/^\([a-z]*\):.*## /make \1 /p' $(firstword $(MAKEFILE_LIST)) | awk '{ printf "%-14s", $$1 " " $$2; $$1 = $$2 = ""; print }'

clean: ## remove everything that was built, but not the virtual environment
	@rm -rf build .hypothesis .pytest_cache .ruff_cache
	@find . -name .venv -prune -o -name __pycache__ -type d -print0 | xargs -0 rm -rf

distclean: clean ## remove the virtual environment as well
	@rm -rf .venv

environment:
	@command -v $(PYTHON) >/dev/null || { echo "error: $(PYTHON) is missing: install Python 3.11 or newer" >&2; exit 2; }
	@$(PYTHON) environment.py
