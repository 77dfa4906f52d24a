"""Every page of the site in a headless browser: `make check-site`.

    python -m benchmarks site_check [SITE] [--pictures DIR] [--sizes FILE] [WORD ...]

Each page is opened at two widths. It must fit the width, hide no text, name every picture, have
links that lead somewhere and no error on the console; the search must find the right page. ``WORD``
selects the pages whose path contains it.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import argparse
import functools
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import quote, unquote, urldefrag

from benchmarks.campaigns.browser import Browser

#: Widths of a page [pixels]: a desk and a telephone.
WIDTHS = (1400, 420)
#: Largest pages and total [bytes]; without the network's help, what a reader downloads.
MOST_BYTES, MOST_TOTAL = 600_000, 60_000_000
#: Pages of the builder without an article of their own.
NO_ARTICLE = {"genindex.html", "search.html"}
#: What a user types, and the page that should be among the first three.
SEARCHES = {
    "rubber": "rubber",
    "hyperelastic": "rubber",
    "clip": "howto/snap_fit",
    "press fit": "howto/press_fit",
    "springback": "howto/steps",
    "let go": "howto/steps",
    "snap-fit": "howto/snap_fit",
    "hinge": "howto/flexure",
    "flexure": "howto/flexure",
    "bistable": "howto/bistable_switch",
    "reaction force": "output",
    "CPS4R": "reduced-integration",
    "why does it not converge": "decisions",
    "contact": "contact",
    "friction": "contact",
    "impact": "howto/impact",
    "buckling": "howto/buckling",
    "arc length": "paths",
    "plasticity": "plasticity",
    "restart": "restart",
    "units": "output",
    "install": "install",
    "abaqus": "howto/from_abaqus",
    "gmsh": "howto/gmsh",
    "seal": "howto/seal",
    "frequency": "dynamics",
    "beam": "line-elements",
    "thermal": "thermal",
    "report": "howto/report",
    "sweep": "howto/sweep",
    "which element": "decisions",
    "step": "generated/keywords/step",
    "Model": "generated/reference/model",
}
READY = (
    "document.readyState === 'complete' &&"
    " (!window.MathJax || (window.MathJax.startup && window.corotaMath === 'done'))"
)
#: Equations are set after the page has loaded; wait for them.
WAIT_FOR_MATH = (
    "Promise.resolve(window.MathJax?.startup?.promise).then(() => (window.corotaMath = 'done'))"
)
#: What a page shows: faults of its layout, links, anchors.
INSPECT = r"""(() => {
  const faults = [];
  const wide = document.documentElement.clientWidth;
  const name = (node) => {
    const text = (node.textContent || node.alt || "").trim().replace(/\s+/g, " ").slice(0, 50);
    return `<${node.tagName.toLowerCase()} class="${node.getAttribute("class") || ""}"> ${text}`;
  };
  const shown = (node) => node.checkVisibility({ opacityProperty: true, visibilityProperty: true });
  const scrolls = (node) => {
    for (let up = node; up && up !== document.body; up = up.parentElement) {
      if (getComputedStyle(up).overflowX !== "visible") return true;
    }
    return false;
  };
  if (document.documentElement.scrollWidth > wide + 1) {
    const all = [...document.body.querySelectorAll("*")].filter(shown);
    const out = all.filter((n) => n.getBoundingClientRect().right > wide + 1 && !scrolls(n));
    faults.push(`wider than the page: ${out.slice(-1).map(name).join("") || "something"}`);
  }
  for (const node of document.body.querySelectorAll("*")) {
    if (node.closest("svg, .math, mjx-container, .visually-hidden, .sr-only, .skip-link")) continue;
    if (node.scrollWidth <= node.clientWidth + 1 || !node.clientWidth || !shown(node)) continue;
    const style = getComputedStyle(node);
    const hides = ["hidden", "clip"].includes(style.overflowX);
    if (hides && node.textContent.trim()) faults.push(`hides text: ${name(node)}`);
    // On a desk nothing scrolls sideways; on a telephone wide tables and code may.
    const article = node.closest("article");
    if (wide > 1000 && article && ["auto", "scroll"].includes(style.overflowX)) {
      faults.push(`scrolls sideways: ${name(node)}`);
    }
  }
  for (const text of document.querySelectorAll("svg text")) {
    const box = text.getBoundingClientRect();
    const svg = text.ownerSVGElement.getBoundingClientRect();
    const out = box.left < svg.left - 1 || box.right > svg.right + 1 || box.bottom > svg.bottom + 1;
    if (box.width && out) {
      faults.push(`text leaves its figure: ${name(text)}`);
    }
  }
  for (const image of document.images) {
    if (!image.closest("article")) continue;
    if (!image.alt.trim()) faults.push(`no alternative text: ${image.getAttribute("src")}`);
    if (image.complete && !image.naturalWidth) faults.push(`picture is missing: ${image.src}`);
  }
  for (const figure of document.querySelectorAll("article svg[role=img]")) {
    if (!figure.querySelector("title")) faults.push(`figure without a title: ${name(figure)}`);
  }
  const links = [...document.querySelectorAll("a[href]")].map((a) => a.href);
  const anchors = [...document.querySelectorAll("[id]")].map((n) => n.id);
  return { faults: [...new Set(faults)], links: [...new Set(links)], anchors };
})()"""


class _Quiet(SimpleHTTPRequestHandler):
    """A server that says nothing."""

    def log_message(self, *_: object) -> None:
        """Do not log."""


@contextmanager
def serve(site: Path) -> Iterator[str]:
    """Serve a folder on this machine while the block runs; gives its address."""
    handler = functools.partial(_Quiet, directory=str(site))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        try:
            yield f"http://127.0.0.1:{server.server_port}/"
        finally:
            server.shutdown()


def pages_of(site: Path) -> list[str]:
    """Pages by their path in the site, those of the theme left out."""
    found = sorted(p.relative_to(site).as_posix() for p in site.rglob("*.html"))
    return [page for page in found if not page.startswith(("_static/", "_modules/"))]


def inspect(browser: Browser, base: str, page: str, pictures: Path | None) -> dict[str, Any]:
    """Open one page at every width: its faults, links and anchors."""
    faults: list[str] = []
    found: dict[str, Any] = {}
    browser.resize(WIDTHS[0], 1000)
    browser.open(base + page, "document.readyState === 'complete'")
    browser.run("for (const image of document.images) image.loading = 'eager';")
    browser.run(WAIT_FOR_MATH)
    browser.wait(READY)
    for width in WIDTHS:
        browser.resize(width, 1000)
        browser.run(
            "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
        )
        found = browser.run(INSPECT)
        faults += [f"{width}: {text}" for text in found["faults"]]
        if pictures is not None:
            name = page.removesuffix(".html").replace("/", "-")
            browser.picture(pictures / f"{name}-{width}.png", whole=True)
    faults += [f"console: {text}" for text in browser.console]
    faults += [f"asks for {a}" for a in browser.requests if not a.startswith(base)]
    return {"faults": faults, "links": found["links"], "anchors": set(found["anchors"])}


def dead_links(base: str, site: Path, seen: dict[str, dict[str, Any]]) -> Iterator[str]:
    """Links within the site whose page or place does not exist."""
    for page, found in seen.items():
        for link in found["links"]:
            if not link.startswith(base):
                continue
            address, place = urldefrag(link.removeprefix(base))
            target = unquote(address.split("?")[0]) or "index.html"
            if not (site / target).is_file():
                yield f"{page}: dead link {target}"
            elif place and target in seen and unquote(place) not in seen[target]["anchors"]:
                yield f"{page}: no place {place} in {target}"


def search(browser: Browser, base: str, words: str) -> list[str]:
    """The first pages that the search of the site lists, without their ending, each once."""
    browser.open(f"{base}search.html?q={quote(words)}", "document.readyState === 'complete'")
    done = "document.querySelector('#search-results .search-summary')?.textContent.match(/\\d|not/)"
    browser.wait(f"{done} && !document.querySelector('#search-progress .dots')", 30.0)
    links = browser.run(
        "[...document.querySelectorAll('#search-results ul.search li > a')].map((a) => a.href)"
    )
    pages = [urldefrag(link.removeprefix(base).split("?")[0])[0] for link in links]
    return list(dict.fromkeys(page.removesuffix(".html") for page in pages))


def check(site: Path, wanted: list[str], pictures: Path | None = None) -> list[str]:
    """Open all pages, or those whose path contains a word; the list of faults."""
    faults: list[str] = []
    seen: dict[str, dict[str, Any]] = {}
    every = pages_of(site)
    with serve(site) as base, Browser() as browser:
        for page in every:
            if wanted and not any(word in page for word in wanted):
                continue
            seen[page] = inspect(browser, base, page, pictures)
            faults += [f"{page}: {text}" for text in seen[page]["faults"]]
            size = (site / page).stat().st_size
            if size > MOST_BYTES:
                faults.append(f"{page}: {size} bytes")
        faults += dead_links(base, site, seen)
        if not wanted:
            for words, right in SEARCHES.items():
                first = search(browser, base, words)[:3]
                if right not in first:
                    faults.append(f"search for {words!r} finds {first}, not {right}")
    total = sum(p.stat().st_size for p in site.rglob("*") if p.is_file())
    if total > MOST_TOTAL:
        faults.append(f"the site has {total} bytes")
    largest = max(seen, key=lambda page: (site / page).stat().st_size)
    print(f"{len(seen)} pages at {len(WIDTHS)} widths; site {total / 1e6:.1f} MB")
    print(f"largest page {largest}, {(site / largest).stat().st_size / 1e3:.0f} kB")
    return faults


def write_sizes(site: Path, path: Path) -> None:
    """Write the size of each page [bytes] as CSV, the largest first, and the total."""
    sizes = {page: (site / page).stat().st_size for page in pages_of(site)}
    rows = [f"{page},{size}" for page, size in sorted(sizes.items(), key=lambda item: -item[1])]
    path.write_text("\n".join(["page,bytes", *rows, f"all,{sum(sizes.values())}", ""]))


def main() -> int:
    """Check the site; 1 where something is wrong."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("site", nargs="?", default="build/site", type=Path)
    parser.add_argument("words", nargs="*", help="pages whose path contains a word")
    parser.add_argument("--pictures", type=Path, help="write pictures of the pages there")
    parser.add_argument("--sizes", type=Path, help="write the size of each page there as CSV")
    options = parser.parse_args()
    if options.sizes is not None:
        write_sizes(options.site, options.sizes)
    if options.pictures is not None:
        options.pictures.mkdir(parents=True, exist_ok=True)
    faults = check(options.site.resolve(), options.words, options.pictures)
    for fault in faults:
        print(fault)
    print(f"{len(faults)} faults")
    return int(bool(faults))


if __name__ == "__main__":
    raise SystemExit(main())
