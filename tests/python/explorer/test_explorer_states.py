"""Every state of the explorer's page shows what it says, whatever was done before: title, list, sentence and picture
agree. Sequences of what hands do come from hypothesis, always the same ones; what came of a sequence is read once the
page asks for no more."""

import json

import pytest
from conftest import EXTENSIVE, wait_for
from explorer_page import Page
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

pytest_plugins = ("explorer_page",)

QUESTION = "Where does the pendulum end?"
places = st.floats(0.05, 0.95).map(lambda share: round(share, 3))
ACTIONS = st.one_of(
    st.tuples(st.just("zoom"), st.sampled_from([-900, -300, -100, 400]), places, places),
    st.tuples(st.just("key"),
              st.sampled_from(["h", "h", "Escape", "Escape", "Backspace", "n", "-", "ArrowRight", "w", "c", "d"])),
    st.tuples(st.just("click"), places, places),
    st.tuples(st.just("story"), st.sampled_from(["show-me", "story-next", "story-next", "story-back", "story-end"])),
    st.tuples(st.just("jump"),
              st.sampled_from(["theta=1..1.5&velocity=-0.2..0.2", "theta=-3..3&velocity=-1..1&pendulum.m=0.5"])),
    st.tuples(st.just("slider"), st.floats(-0.9, 0.9).map(lambda place: round(place, 2))),
    st.tuples(st.just("level"), st.sampled_from(["look", "explore", "measure"])))

SETTLED = """(() => { const {basins, dive, stories} = explorer, {state} = document.body.dataset;
    return ["done", "error"].includes(state) && !dive.diving && !stories.busy && !basins.written
    && basins.panes.every((pane) => !pane.pursuing && !pane.moving && !pane.drawn); })()"""
SAID = """(() => { const {state, basins, stories} = explorer, pane = basins.panes[0], {top} = pane, counts = {};
    for (const label of top.labels) counts[label] = (counts[label] ?? 0) + 1;
    const size = top.labels.length, {attractors} = top.catalogue;
    pane.drawNow();
    const context = pane.basins.getContext("2d"), wrong = [], at = (x, y) => pane.cellAt(x, y);
    for (let i = 1; i < 24; i++) for (let j = 1; j < 24; j++) {
        const [x, y] = [i / 24, j / 24], around = [-3, 3].map((step) => at(x + step / pane.basins.width, y)),
          found = at(x, y);
        if (!found || around.some((one) => !one
          || one.frame.labels[one.cell] !== found.frame.labels[found.cell])) continue;
        const label = found.frame.labels[found.cell], {colour} = attractors.find(({id}) => id === label);
        const {width, height} = pane.basins;
        const pixel = context.getImageData(Math.floor(x * width), Math.floor((1 - y) * height), 1, 1).data;
        const drawn = `#${[...pixel].slice(0, 3).map((n) => n.toString(16).padStart(2, "0")).join("")}`;
        if (drawn !== colour) wrong.push([x, y, drawn, colour]); }
    return {level: state.level, title: $("title").textContent, page: document.title, scene: state.scene,
      pendulum: state.pendulum,
        named: state.title, counts, size, kinds: Object.fromEntries(attractors.map(({id, name, kind}) => [id, [name,
          kind]])),
        list: [...$("legend").rows].map((row) => [row.dataset.name, Number(row.dataset.share),
          row.cells[2].textContent]),
        pale: $("legend").classList.contains("stale"), sentence: $("sentence").textContent, wrong,
        stale: basins.panes.map((one) => one.isStale || one.root.classList.contains("stale")),
          whole: state.window.equals(state.home),
        window: JSON.stringify(state.window.toRequest()), written: $("where").dataset.window,
        drawn: JSON.stringify(pane.window.toRequest()),
        values: Object.fromEntries([...document.querySelectorAll(".slider input[type=text]")]
          .map((one) => [one.id.slice(6), one.value])),
        beside: [...document.querySelectorAll(".slider")]
          .map((row) => row.querySelector("output")?.textContent ?? null),
        story: [document.body.dataset.story ?? null, stories.story?.title ?? null, $("story-place").textContent,
                stories.story && `${stories.step + 1} / ${stories.story.steps.length}`],
        radio: document.querySelector("#levels :checked").value, panes: basins.panes.length,
          isCompared: Boolean(state.other)}; })()"""


def done(page, action):
    kind, *what = action
    if kind == "zoom":
        page.wheel(what[1], what[2], what[0])
    elif kind == "key":
        page.key(*what)
    elif kind == "click":
        page.run("explorer.basins.click(explorer.basins.panes[0], ...arguments)", *what)
    elif kind == "story" and (what[0] == "show-me") != page.run("Boolean(explorer.stories.story)"):
        page.press(*what)
    elif kind == "jump":
        page.run("void (location.hash = arguments[0])", *what)
    elif kind == "slider":  # a story has another
        page.run("((range, place) => { range.value = place; range.dispatchEvent(new Event('input')); })"
                 "($('slider-m') ?? $('slider-drive_amplitude'), arguments[0])", what[0])
    elif kind == "level" and not page.run("Boolean(explorer.stories.story)"):  # a story hides them
        page.run("document.querySelector(`#levels [value=${arguments[0]}]`).click()", *what)


def percent(share):
    return ("0 %" if share == 0 else f"{100 * share:.1f} %" if share >= 0.01 else f"{100 * share:.2f} %"
            if share >= 1e-4 else "< 0.01 %")


def check(said):
    """What the page says, against the labels of the picture that it shows."""
    assert said["stale"] == [False] * said["panes"] and not said["pale"] and said["panes"] == 1 + said["isCompared"]
    assert said["wrong"] == [] and said["window"] == said["written"] == said["drawn"]
    shares = {}
    for label, count in said["counts"].items():
        name = said["kinds"][label][said["level"] == "look"]
        shares[name] = shares.get(name, 0) + count / said["size"]
    listed = {name: share for name, share, _ in said["list"] if share}
    assert listed == pytest.approx(shares) and all(words == percent(share) for _, share, words in said["list"])
    # Names are kinds in the double
    found = [(kind, percent(shares[kind])) for kind in ("inverted", "flutter") if shares.get(kind)]
    said_of = {"inverted": ("can stand: {} of all starts.", "{} of the starts shown end inverted."),
               "flutter": ("can flutter: {} of all starts.", "{} of the starts shown end in flutter.")}
    none = ("cannot stand: it falls, or turns.", "None of the starts shown ends inverted.")
    sentence = said_of[found[0][0]][not said["whole"]].format(found[0][1]) if found else none[not said["whole"]]
    assert said["isCompared"] or said["sentence"].removeprefix("Now it ").removeprefix("It ") == sentence
    differing = [name for name in said["pendulum"] if said["pendulum"][name] != said["scene"][name]]
    title = ", ".join(f"{name.replace('_', ' ')} {said['pendulum'][name]} instead of {said['scene'][name]}"
                      for name in differing[:2])
    assert said["page"] == (title + " …" * (len(differing) > 2) or said["named"])
    assert said["title"] == (QUESTION if said["level"] == "look" else said["page"]) and said["radio"] == said["level"]
    assert said["isCompared"] or all(value == said["pendulum"][name] for name, value in said["values"].items())
    assert said["isCompared"] or set(said["beside"]) - {None, ""} <= set(said["pendulum"].values())
    assert said["story"][0] == said["story"][1] and (said["story"][0] is None or said["story"][2] == said["story"][3])


@given(actions=st.lists(ACTIONS, min_size=1, max_size=8))
@settings(max_examples=200 if EXTENSIVE else 5, derandomize=True, deadline=None, database=None,
          report_multiple_bugs=False, suppress_health_check=list(HealthCheck))
@example(actions=[("zoom", -900, 0.3, 0.5), ("key", "h"), ("key", "Escape")])
@example(actions=[("story", "show-me"), ("story", "story-next"), ("slider", 0.3), ("story", "story-end"),
                  ("level", "explore")])
@example(actions=[("level", "measure"), ("key", "d"), ("click", 0.4, 0.5), ("click", 0.61, 0.5),
                  ("zoom", -300, 0.2, 0.2), ("key", "h")])
def test_title_list_sentence_and_picture_agree_in_every_state(driver, striped, actions):
    driver.get("about:blank")
    driver.execute_cdp_cmd("Network.clearBrowserCookies", {})
    page = Page(driver, striped.address() + "#painter=2d&shade=none&samples=1&quality=moving&middle=down")
    page.wait()
    for action in actions:
        done(page, action)
    if page.run("explorer.basins.onClick !== null && explorer.basins.onClick !== undefined || explorer.dive.diving"):
        page.key("Escape")  # a dive goes on for half a minute
    assert wait_for(lambda: page.run(SETTLED)), json.dumps(actions)
    if page.run("explorer.basins.panes.some((pane) => pane.isStopped)"):
        page.key("h")  # a picture that was cancelled says so; Home always works
        page.press("cancel") if page.run("explorer.basins.panes.some((pane) => pane.isStopped)") else None
        assert wait_for(lambda: page.run(SETTLED))
    check(page.run(SAID))
    driver.get("about:blank")
