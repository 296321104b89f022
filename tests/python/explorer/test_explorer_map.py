"""The map of the explorer's page: its regions, its point, what happens where the point crosses curves; over the double
of the program."""

import pytest
from conftest import wait_for
from kapitza.style import KINDS

pytest_plugins = ("explorer_page",)


def test_regions_of_the_map_are_named_and_coloured_by_what_matters(page):
    """Shades of the number of motions said nothing of which they are."""
    script = """(() => { const classes = ["rotation 1/1", "inverted", "down", "flutter",
        "asymmetric 3-nodding"].map((name) => ({name}));
        const lists = [[[0, 1], [1, 1], [2, 1]], [[0, 1], [3, 1]], [[2, 1], [0, 1]], [[0, 1]], [[4, 1]], null];
        const list = [...Array(36)].map((_, i) => i % 6), atlas = {classes, lists, cells: 6, list,
          listAt: ([x]) => Math.floor(6 * x)};
        const {canvas, kinds} = its.regionPicture(atlas, explorer.state.kinds), context = canvas.getContext("2d");
        const pixel = (x) => [...context.getImageData(x, 3, 1, 1).data].slice(0, 3);
        const hexadecimal = (x) => `#${pixel(x).map((n) => n.toString(16).padStart(2, 0)).join("")}`;
        return [kinds, [0, 1, 2, 3, 4, 5].map((x) => [its.regionWords(atlas, [(x + 0.5) / 6, 0]), hexadecimal(x)])];
          })()"""
    kinds, places = page.module("backdrop.js", script)
    words = ["can stand", "can flutter", "down", "rotations only", "other motions", "not known"]
    assert kinds == places and [one for one, _ in kinds] == words
    assert [colour for _, colour in kinds[:4]] == [KINDS[kind]
                                                   for kind in ("inverted", "flutter", "down", "rotation +")]


def test_the_point_of_the_map_is_the_pendulum(page):
    """The double of the program draws charts, and no atlas."""
    page.press("map-shown")
    assert wait_for(lambda: page.run("document.querySelector('#map .note').textContent").startswith("No curves: "), 60)
    listed = page.run("[...document.querySelectorAll('.kinds > span')].map((entry) => entry.textContent)")
    assert listed == ["can stand", "down", "other motions"]  # every colour of the chart
    assert "One start near inverted" in page.run("document.querySelector('.kinds').textContent")
    page.run("explorer.map.go([0.75, 0.5])")
    page.wait()
    assert page.run("[explorer.state.pendulum.k, explorer.state.pendulum.m]") == ["1", "0.375"]
    page.run("explorer.map.over.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowUp', bubbles: true, "
             "cancelable: true}))")
    assert page.run("[explorer.state.pendulum.m, explorer.map.place[1]]") == ["0.3825", pytest.approx(0.51)]
    ends = page.run(
        "['#map .over', '.pane .over'].map((name) => document.querySelector(name).getBoundingClientRect().bottom)")
    assert ends[0] == ends[1]  # map and basins stand on one line
    refused = [entry["message"] for entry in page.driver.get_log("browser") if entry["level"] == "SEVERE"]
    # The module's own look at the log would find these, if this test is its last
    assert all("/atlas " in message for message in refused)
    page.press("map-shown")
    assert page.run("$('map').hidden")


ATLAS = """(() => { const curve = { kind: "period_doubling", period: 1, name: "inverted", first: 0, points: 2 };
    const header = { max_period: 2, mirrored: true, cells: 2, points: 2, file: "f", low: [0, 2],
        width: [100, 2], curves: [curve], lists: [[[0, 1]], [[2, 1], [1, 1]]],
        classes: [{ name: "inverted", period: 1, symmetric: true },
                  { name: "flutter", period: 2, symmetric: true },
                  { name: "rotation 2/2", period: 2 }] };
    const bytes = new Uint8Array(42);  // a level line at y = 0.5, below which upright attracts
    new Float32Array(bytes.buffer, 0, 8).set([0, 1, 0.5, 0.5, 0, 0, -1, -1]);
    new Uint16Array(bytes.buffer, 32, 4).set([0, 0, 1, 1]);
    bytes.set([1, 1], 40); return [header, bytes]; })()"""


def test_crossing_a_curve_says_what_happens(page):
    script = f"""const done = arguments[0]; Promise.all(["atlas", "crossings",
        "map_plane"].map((name) => import(`/${{name}}.js`)))
        .then(([atlas, crossings, ground]) => {{ const map = new atlas.Atlas(...{ATLAS});
            const axes = [{{name: "q", unit: "", low: 0, high: 10}}, {{name: "a", unit: "mm", low: 0, high: 0.936}}];
            const turned = {{...map.curves[0], kind: "fold", name: "rotation 2/2"}};
            const turning = Object.assign(Object.create(map),
                {{crossed: (...way) => map.crossed(...way).map((one) => ({{...one, curve: turned}}))}});
            done([crossings.happening(map, [0.3, 0.2], [0.3, 0.9]), crossings.happening(map, [0.3, 0.9], [0.3, 0.2]),
                  crossings.happening(turning, [0.3, 0.2], [0.3, 0.9]),
                  crossings.happening(map, [0.3, 0.2], [0.6, 0.3]), map.motionsAt([0.1, 0.7])[1].name,
                  map.nearest([0.2, 0.52], [0.1, 0.1]).name,
                  ground.listedAt({{ atlas: map, axes, others: '{{"q":null,"a":null}}' }}, {{q: "5", a: "0.234 mm"}}),
                  ground.listedAt({{ atlas: map, axes, others: '{{"q":null,"a":null}}' }}, {{q: "5", a: "1 mm"}})]);
                    }})"""
    up, down, turns, along, there, near, listed, outside = page.driver.execute_async_script(script)
    assert up == "Flutter is born: inverted loses its stability by period doubling"
    assert down == "Inverted is stable again; flutter ends in it" and along == "" and (there,
                                                                                       near) == ("flutter", "inverted")
    assert turns == "Rotation 2/2 ends: it meets an unstable motion (fold)"
    assert listed == {"atlas": "f", "x": 50, "y": pytest.approx(2.5)} and outside == {}  # by the numbers of the file


def test_a_jump_over_several_curves_says_what_lives_at_its_ends(modules):
    """It named the first of 43 curves: "inverted is stable again", beside a slider by which it does not stand."""
    script = f"""import("/crossings.js").then(({{happening}}) => {{ const map = new its.Atlas(...{ATLAS});
        const leans = {{...map.curves[0], kind: "rest_leans"}}, up = [[0.3, 0.2], [0.3, 0.9]], within = [[0.3, 0.7],
          [0.3, 0.9]];
        map.crossed = () => [map.curves[0], leans].map((curve) => ({{curve, point: 0, at: 0.5, into: true}}));
        const said = [up, up.toReversed(), within].map((way) => happening(map, ...way));
        map.classes.push({{name: "x 5/5", period: 5}}, {{name: "y 3/3", period: 3}});
        map.lists[1] = [3, 4, 2, 1].map((motion) => [motion, 1]);
        said.push(happening(map, ...up)); map.lists[0] = null; return [...said, happening(map, ...up)]; }})"""
    up, down, within, many, unknown = modules.module("atlas.js", script)
    assert up == "New here: rotation 2/2, flutter. Gone: inverted"
    assert down == "New here: inverted. Gone: rotation 2/2, flutter"
    assert within == "" and many == "New here: rotation 2/2, flutter, y 3/3 and 1 more. Gone: inverted"
    assert unknown == "What has changed is not known: a curve of the map is missing"
