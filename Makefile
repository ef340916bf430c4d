# make run [FILE=clip]   opens the editor          make bench [ARGS=...]   prints the table of speeds
# make test [ARGS=...]   checks everything         make clean              removes what make has made
# Windows and macOS without make: uv run main.py, uv run pytest
VENV ?= .venv
PY   := $(VENV)/bin/python
export VENV PYTHON UV
# Without kept bytecode every start takes 0.3 s longer.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: run test bench screenshots clean

run:
	@tools/venv.sh run
	@$(PY) -m app.preflight --install
	@exec $(PY) main.py $(if $(FILE),"$(FILE)")

test:
	@tools/venv.sh dev
	@$(PY) -m app.preflight --tests
	$(PY) -m ruff check .
	$(PY) -m ruff format --check .
	$(PY) -m mypy
	@$(PY) -c 'import sys; from importlinter.cli import lint_imports_command; sys.exit(lint_imports_command())'
	QT_QPA_PLATFORM=offscreen $(PY) -m pytest -m "not window" $(ARGS)
	@echo tools/screen.sh $(PY) -m pytest -m window
	@tools/screen.sh $(PY) -m pytest -m window $(ARGS); case $$? in \
	    0) echo "make test: lint, format, types, imports and all tests are good." ;; \
	    5) test -n "$(ARGS)" && echo "make test: all is good; of what was asked for no test needs a screen." ;; \
	    77) echo "make test: all is good but the window tests, which were not run (see above)." ;; \
	    *) exit 1 ;; esac

bench:
	@tools/venv.sh dev
	@$(PY) -m app.preflight --tests
	QT_QPA_PLATFORM=offscreen $(PY) -m tests.bench $(ARGS)

screenshots:
	@tools/venv.sh dev
	QT_QPA_PLATFORM=offscreen $(PY) -m tools.screenshots

clean:
	rm -rf $(VENV) .uv build dist .hypothesis .mypy_cache .ruff_cache .import_linter_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
