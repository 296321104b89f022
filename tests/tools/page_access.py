#!/usr/bin/env python3
"""What axe-core finds on the explorer's page in its main states: both themes on a desk and on a phone. Status 1 if
something is serious.

    page_access.py node_modules/axe-core/axe.min.js"""

import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / folder) for folder in ("python", "tests/python", "tests/tools")]
from explorer_page import Page, Server, browser, wait_for  # noqa: E402

SCREENS = ((1440, 900, "light"), (1440, 900, "dark"), (390, 844, "light"), (390, 844, "dark"))
MENU = "document.querySelectorAll('.menu summary')[{}].click()"
# name: what brings the state, what ends it
STATES = {
    "look": ("0", "0"),
    "explore": ("explorer.state.show('explore')", "0"),
    "map": ("explorer.state.change({map: 'on'})", "explorer.state.change({map: 'off'})"),
    "measure": ("explorer.state.show('measure')", "0"),
    "pinned": ("document.querySelector('#legend button').click()", "0"),
    "compare": ("$('compare').click()", "$('compare').click()"),
    **{f"menu {i}": (MENU.format(i), MENU.format(i)) for i in range(2)},
    "help": ("$('help-shown').click()", "$('help').close()"),
    "values": ("$('values-shown').click()", "$('values-shown').click()"),
    "large letters": ("explorer.state.change({letters: 'large'})", "explorer.state.change({letters: 'usual'})"),
    "story": ("$('tell').click()", "$('story-end').click()"),
}
LOOK = "const done = arguments[0]; axe.run().then(({violations}) => done(violations.map(({id, impact, nodes}) => " \
       "[impact, id, nodes.map(({target}) => String(target)).join(' ')])))"


def looked_at(page, axe, name):
    """[[impact, rule, places], ...] of a state."""
    begin, end = STATES[name]
    page.run(begin)
    if name == "story":
        wait_for(lambda: page.run("Boolean($('stories').querySelector('div button'))"))
        page.run("$('stories').querySelector('div button').click()")
    wait_for(lambda: page.state() in ("done", "error"))
    page.driver.execute_script(axe)
    found = page.driver.execute_async_script(LOOK)
    page.run(end)
    return found


def main():
    axe = Path(sys.argv[1]).read_text(encoding="utf-8")
    server, worst = Server(ROOT / "scenes" / "small.yaml"), 0
    with tempfile.TemporaryDirectory() as profile, browser(Path(profile), "1440,1040") as driver:
        driver.set_script_timeout(120)
        for width, height, theme in SCREENS:
            screen = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500}
            driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
            driver.get("about:blank")
            page = Page(driver, server.address() + f"#level=look&samples=1&theme={theme}")
            page.wait()
            for name in STATES:
                found = looked_at(page, axe, name)
                worst += any(impact in ("serious", "critical") for impact, _, _ in found)
                print(f"{width} x {height} {theme}, {name}: {found or 'nothing'}", flush=True)
        driver.get("about:blank")
    server.end()
    return 1 if worst else 0


if __name__ == "__main__":
    sys.exit(main())
