# Everything a fresh machine with Python >= 3.11 and make needs. Windows: see README.md for the pip equivalents.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
OUT ?= out

.PHONY: report test oldest lint types floors docs pages check bench release tag clean

$(VENV)/.run: pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(BIN)/python -m pip install --quiet -e ".[pdf,desk]"
	@touch $@

$(VENV)/.test: $(VENV)/.run
	$(BIN)/python -m pip install --quiet -e ".[test]"
	@touch $@

$(VENV)/.dev: $(VENV)/.test
	$(BIN)/python -m pip install --quiet -e ".[dev]"
	@touch $@

report: $(VENV)/.run
	@mkdir -p $(OUT)
	$(BIN)/conveyor power examples/specs/overland.yaml -o $(OUT)/overland.xlsx

test: $(VENV)/.test
	$(BIN)/python -m pytest -n auto --dist worksteal

lint: $(VENV)/.dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(VENV)/.dev
	$(BIN)/mypy

floors: $(VENV)/.dev
	$(BIN)/lint-imports

$(VENV)/.docs: $(VENV)/.run
	$(BIN)/python -m pip install --quiet -e ".[docs]"
	@touch $@

docs: $(VENV)/.docs
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict

check: test lint types floors docs

# The tests with the oldest packages that pyproject.toml allows.
$(VENV)-oldest/.test: pyproject.toml
	$(PYTHON) -m venv $(VENV)-oldest
	$(VENV)-oldest/bin/python -m pip install --quiet uv
	$(VENV)-oldest/bin/uv pip install --quiet --python $(VENV)-oldest/bin/python --resolution lowest-direct -e ".[test]"
	@touch $@

oldest: $(VENV)-oldest/.test
	$(VENV)-oldest/bin/python -m pytest -n auto --dist worksteal

# What is printed from the code: fields, sheets, names, printed and measured cases.
pages: $(VENV)/.test
	$(BIN)/conveyor schema --markdown > docs/spec.md
	$(BIN)/conveyor schema --workbook > docs/workbook.md
	$(BIN)/conveyor schema --nomenclature > docs/nomenclature.md
	$(BIN)/python tests/test_printed_page.py
	$(BIN)/python tests/test_validation_page.py
	$(BIN)/python -m tests.promised_names

bench: $(VENV)/.test
	$(BIN)/python benchmarks/speed.py

$(VENV)/.release: $(VENV)/.run
	$(BIN)/python -m pip install --quiet -e ".[release]"
	@touch $@

# Distributions in dist/, and whether they are what a stranger can install: contents, licences, a fresh environment.
release: $(VENV)/.release
	rm -rf dist
	$(BIN)/python -m build --outdir dist
	$(BIN)/twine check --strict dist/*
	$(BIN)/python -m tests.distribution dist

# A tag publishes (.github/workflows/release.yml): only of a clean tree whose changelog has the version's date.
tag: release
	@git diff --quiet HEAD || { echo "the tree has changes: commit them first"; exit 1; }
	@version=$$($(BIN)/conveyor --version | cut -d' ' -f2); \
	grep -q "^## $$version (20" CHANGELOG.md || { echo "CHANGELOG.md: ## $$version has no date"; exit 1; }; \
	git tag -a "v$$version" -m "conveyor $$version" && echo "now: git push origin v$$version"

clean:
	rm -rf $(OUT) dist .pytest_cache .mypy_cache .ruff_cache
