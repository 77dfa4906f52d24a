"""The page as text: one file, nothing to fetch, and the vendored library as it was published."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import hashlib
import re
from pathlib import Path

import pytest

import corota as ct
from corota.report.content import Content
from corota.report.page import MODULES, asset, page, script


def test_nothing_to_fetch(tmp_path: Path) -> None:
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1), name="a </script> & <b>")
    model.section("all", element="Q4I", material=ct.Elastic(E=1e3, nu=0.3))
    model.fix("left")
    model.force("right", y=0.01)
    path = ct.solve(model, threads=1).report(tmp_path / "page.html")
    text = path.read_text(encoding="utf-8")
    assert "a &lt;/script&gt; &amp; &lt;b&gt;" in text
    assert "default-src 'none'" in text
    assert "connect-src 'none'" in text
    markup = re.sub(r"<(script|style)\b.*?</\1>", "", text, flags=re.DOTALL)
    assert not re.search(r"""(src|href)=["'](?!data:|#)""", markup)
    assert not re.search(r"@import|url\(", asset("style.css"))
    assert "fetch(" not in script().replace("await fetch(`${this.path}/", "")
    assert "{{" not in markup


def test_live_page_may_ask_its_server_only() -> None:
    text = page(None, title="job", live="/token")
    assert "connect-src 'self'" in text
    assert 'data-live="/token"' in text


def test_data_are_not_taken_for_places() -> None:
    text = page(Content("{{data}} {{script}}", {}))
    assert "<title>{{data}} {{script}}</title>" in text


@pytest.mark.parametrize("name", MODULES)
def test_modules_import_what_comes_before(name: str) -> None:
    place = MODULES.index(name)
    for found in re.finditer(
        r'^import \{([^}]*)\} from "\./(\w+)\.js";$', asset(f"{name}.js"), re.M
    ):
        assert found[2] in MODULES[:place]
        exported = re.findall(
            r"^export (?:async )?(?:function\*?|class|const|let) (\w+)",
            asset(f"{found[2]}.js"),
            re.M,
        )
        assert {part.strip() for part in found[1].split(",")} - {""} <= set(exported)
    assert asset(f"{name}.js").count("\nimport ") + asset(f"{name}.js").startswith(
        "import "
    ) == len(re.findall(r"^import \{", asset(f"{name}.js"), re.M))


def test_vendored_library_is_unchanged() -> None:
    rows = re.findall(r"`([\w.]+)` \| `([0-9a-f]{64})`", asset("vendor/README.md"))
    assert len(rows) == 2
    for name, digest in rows:
        assert hashlib.sha256(asset(f"vendor/{name}").encode()).hexdigest() == digest
    assert "MIT" in asset("vendor/LICENSE")
