"""The documentation site (mkdocs.yml) in the folders of the checkout: the links of its pages hold as on a forge."""

from __future__ import annotations

import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/*.md", "materials/README.md")
LINKED = ("docs/figures/*.*g", "examples/06_tutorial.*", "examples/duties/*.yaml", "examples/listed/*.yaml",
          "examples/specs/*.yaml", "conveyor/_library/*.yaml", "conveyor/laws/preliminary_sizing.py",
          "conveyor/pipeline.py", "tests/test_architecture.py", "tests/test_names.py")  # fmt: skip
MODULES = ("spec", "units", "shelf", "contact", "indentation", "rubber", "uncertainty")
INTERFACE = ("conveyor", *(f"conveyor.{name}" for name in MODULES))


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Pages, what they link to, and a page of each public module from its docstrings."""
    root = Path(config.config_file_path).parent
    paths = sorted({p.relative_to(root).as_posix() for part in (*PAGES, *LINKED) for p in root.glob(part)})
    here = [File(path, str(root), config.site_dir, config.use_directory_urls) for path in paths]
    made = [File.generated(config, f"interface/{name}.md", content=f"# {name}\n\n::: {name}\n") for name in INTERFACE]
    return Files([*(file for file in files if file.src_dir != config.docs_dir), *here, *made])


def on_page_markdown(markdown: str, **_: object) -> str:
    """Blocks of code by their language alone: what else tests read behind it ends no fence here."""
    return re.sub(r"^```(\w+) \w.*$", r"```\1", markdown, flags=re.MULTILINE)
