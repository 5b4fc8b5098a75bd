"""The most used mouse and key actions, in the real window: each is done by xdotool, the session is saved by Ctrl+S, and
the saved JSON must say what the action means, in direction, axis and size. Undo takes each back exactly.
usage: hands.py, in an empty folder, with $DISPLAY, the window of 1500 x 950 showing the overview"""
import json
import math
import os
import subprocess
import sys
import time

SESSION = "session.tessera.json"
failures = []


def xdo(*words):
    subprocess.run(["xdotool", *map(str, words)], check=True)


def save(after=0.4):
    """Saves by shortcut, some seconds after the events before it, which are answered first, and returns the session."""
    time.sleep(after)
    before = os.stat(SESSION).st_mtime_ns if os.path.exists(SESSION) else 0
    xdo("key", "ctrl+s")
    for _ in range(4500):
        time.sleep(0.01)
        if os.path.exists(SESSION) and os.stat(SESSION).st_mtime_ns != before:
            with open(SESSION, encoding="utf-8") as file:
                return json.load(file)
    sys.exit("FAILED: Ctrl+S saves nothing")


def drag(start, end, button=1, modifier=None, steps=6):
    words = ["keydown", modifier] if modifier else []
    words += ["mousemove", *start, "sleep", 0.15, "mousedown", button]
    for step in range(1, steps + 1):
        words += ["mousemove", *(round(a + (b - a) * step / steps) for a, b in zip(start, end)), "sleep", 0.04]
    words += ["mouseup", button]
    xdo(*words, *(["keyup", modifier] if modifier else []))


def click(at, button=1, times=1):
    xdo("mousemove", *at, "sleep", 0.15, "click", "--repeat", times, "--delay", 60, button)


def press(*keys, at=None):
    xdo(*(["mousemove", *at, "sleep", 0.15] if at else []), "key", *keys)


def apart():
    """Between two edits of one kind, which in quick succession are one step, or two clicks, which are a double one."""
    time.sleep(0.7)


def check(what, holds, found=""):
    print(("ok      " if holds else "FAILED: ") + what + ("" if holds else f", found {found}"), flush=True)
    if not holds:
        failures.append(what)


def until(what, holds, found=lambda s: ""):
    """Saves until the session is as it should be, for 10 seconds at least, and returns it."""
    end = time.monotonic() + 10
    session = save(0.05)
    while not holds(session) and time.monotonic() < end:
        session = save(0.2)
    check(what, holds(session), found(session))
    return session


def palette(text):
    """Runs the first command that the palette finds, when the pictures before it are drawn. On a busy machine all takes
    longer, as saving does; keys that come before it is open, or before it is closed, are lost."""
    begin = time.monotonic()
    save()
    slow = time.monotonic() - begin
    press("ctrl+shift+p")
    time.sleep(max(1, 2 * slow))
    xdo("type", "--delay", 30, text)
    time.sleep(max(0.5, slow))
    press("Return")
    time.sleep(max(0.5, slow))


def brushes(session):
    return [each["name"] + ("" if each["enabled"] else " off") for each in session["selection"]["brushes"]]


def near(a, b, tolerance):
    return abs(a - b) <= tolerance


def turned(session, axis):
    """Where an axis of the world points in the picture: (right, up, towards the viewer)."""
    w, x, y, z = session["camera"]["orientation"]
    return {
        "x": (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
        "y": (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
        "z": (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)),
    }[axis]


def undone(what, part, before):
    """Ctrl+Z takes the step back: this part of the session is what it was."""
    time.sleep(0.2)
    xdo("key", "ctrl+z")
    return until(f"undo of {what}", lambda s: s[part] == before[part], lambda s: s[part])


def intervals(session):
    """The ranges of the first brush, by parameter."""
    return {each["channel"]: each for each in session["selection"]["brushes"][0]["region"]["intervals"]}


def opacities(session):
    return [point[1] for point in session["transfer"]["T"]["opacity"]]


# Places in the window of 1500 x 950 with the overview.
VOLUME = (310, 420)
BOX_XY, BOX_ZY = ((686, 108), (741, 172)), ((878, 108), (1079, 172))
DENSITY_PLOT = ((737, 568), (818, 618))  # H2O over O2
LENS = (412, 406)  # in the layout of lenses
TIMELINE_Y, TIMELINE_FIRST, TIMELINE_LAST = 864, 23, 1160

press("ctrl+s")
time.sleep(1.5)
press("Return")
for _ in range(100):
    if os.path.exists(SESSION):
        break
    time.sleep(0.1)
time.sleep(1)  # the dialog is closed
start = save()

# The camera: what is dragged follows the mouse.
front = max("xyz", key=lambda axis: abs(turned(start, axis)[2]))
sign = math.copysign(1, turned(start, front)[2])
drag(VOLUME, (410, 420))
s = until("a drag to the right turns what is in front to the right",
          lambda s: sign * turned(s, front)[0] > sign * turned(start, front)[0] + 0.1, lambda s: turned(s, front))
s = undone("turning", "camera", start)
drag(VOLUME, (310, 340))
s = until("a drag upwards turns what is in front upwards",
          lambda s: sign * turned(s, front)[1] > sign * turned(start, front)[1] + 0.05, lambda s: turned(s, front))
s = undone("turning upwards", "camera", start)
drag(VOLUME, (370, 420), button=2)
right = [turned(start, axis)[0] for axis in "xyz"]
s = until("a drag of the middle button to the right moves the picture to the right",
          lambda s: sum(a * b for a, b in zip(right, s["camera"]["target"])) < -0.02, lambda s: s["camera"]["target"])
check("panning does not turn", s["camera"]["orientation"] == start["camera"]["orientation"])
s = undone("panning", "camera", start)
click(VOLUME, button=4)
s = until("the wheel forward comes nearer", lambda s: s["camera"]["distance"] < 0.98 * start["camera"]["distance"],
          lambda s: s["camera"])
s = undone("zooming", "camera", start)
press("1", at=VOLUME)
s = until("1 looks along z", lambda s: near(abs(turned(s, "z")[2]), 1, 1e-3) or near(abs(turned(s, "x")[2]), 1, 1e-3),
          lambda s: s["camera"])
press("r", at=VOLUME)
s = until("R shows everything from the standard direction",
          lambda s: near(turned(s, "y")[1], turned(start, "y")[1], 0.2), lambda s: turned(s, "y"))

# The cross-hair: a double click in the volume, a drag in a slice.
before = save()
click((330, 330), times=2)
s = until("a double click in the volume moves the cross-hair", lambda s: s["cursor"] != before["cursor"],
          lambda s: s["cursor"])
(x0, y0), (x1, y1) = BOX_ZY
drag((x0 + 100, y0 + 30), (x0 + round(0.75 * (x1 - x0)), y0 + round(0.25 * (y1 - y0))))
s = until("a drag in the slice along z puts the cross-hair under the mouse (z)",
          lambda s: near(s["cursor"][2], 0.03, 0.0006), lambda s: s["cursor"])
# y is drawn by cells: a quarter from the top is in cell 9 of 13, 771 to 871 um, the middle that of the membrane.
check("a drag in the slice along z puts the cross-hair under the mouse (y)", near(s["cursor"][1], 0.846e-3, 4e-5),
      s["cursor"])
held = s["cursor"][2]
(x0, y0), (x1, y1) = BOX_XY
drag((x0 + 20, y0 + 30), (x0 + round(0.25 * (x1 - x0)), y0 + round(0.5 * (y1 - y0))))
s = until("a drag in the slice across z moves x and y", lambda s: near(s["cursor"][0], 0.25 * 2.2e-3, 8e-5) and
      near(s["cursor"][1], 0.6355e-3, 2e-5),
          lambda s: s["cursor"])
check("and leaves z", s["cursor"][2] == held, s["cursor"])

# Time: the slider, arrows, Home and End, playing.
middle = (TIMELINE_FIRST + TIMELINE_LAST) // 2
drag((TIMELINE_LAST, TIMELINE_Y), (middle, TIMELINE_Y))
s = until("the middle of the timeline is the middle of the times", lambda s: near(s["time"], 0.345, 0.016),
          lambda s: s["time"])
views = s["views"]
press("Home", at=(middle, 820))
until("Home is the first time", lambda s: s["time"] == 0)
press("Right", "Right", "Right")
until("Right goes one time on", lambda s: near(s["time"], 0.09, 1e-6), lambda s: s["time"])
press("Left")
until("Left goes one time back", lambda s: near(s["time"], 0.06, 1e-6), lambda s: s["time"])
press("space")
until("Space plays", lambda s: s["time"] > 0.08, lambda s: s["time"])
press("space")
at = save()["time"]
time.sleep(1)
s = save()
check("Space pauses", s["time"] == at, s["time"] - at)
check("keys of time change nothing else", s["views"] == views)
press("End")
s = until("End is the last time", lambda s: near(s["time"], 0.69, 1e-9), lambda s: s["time"])

# Brushes in a plot: a rectangle, moved, another by Shift, removed by a right click, and Esc.
(x0, y0), (x1, y1) = DENSITY_PLOT
drag((x0 + 15, y0 + 10), (x0 + 45, y0 + 30))
s = until("a drag in a plot makes one brush", lambda s: len(s["selection"]["brushes"]) == 1)
check("whose settings come to the front", s["views"]["layers"]["task"] == "brushes", s["views"]["layers"])
ranges = intervals(s)
check("its parameters are those of the plot", sorted(ranges) == ["H2O", "O2"], sorted(ranges))
drag((x0 + 30, y0 + 20), (x0 + 40, y0 + 20))
s = until("a brush dragged to the right moves to the right",
          lambda s: intervals(s)["O2"]["lo"] > ranges["O2"]["lo"] and intervals(s)["O2"]["hi"] > ranges["O2"]["hi"], intervals)
later = intervals(s)
check("and not along the vertical axis", later["H2O"] == ranges["H2O"], later)
drag((x0 + 60, y0 + 8), (x0 + 78, y0 + 36), modifier="shift")
s = until("Shift adds a brush", lambda s: len(s["selection"]["brushes"]) == 2,
          lambda s: len(s["selection"]["brushes"]))
click((x0 + 69, y0 + 22), button=3)
s = until("a right click removes the brush under the mouse",
          lambda s: len(s["selection"]["brushes"]) == 1 and intervals(s) == later, lambda s: s["selection"]["brushes"])

# What was clicked last does not answer to the keys of time.
views = save()["views"]
press("Home", at=(middle, 820))
until("Home after a drag in a plot", lambda s: s["time"] == 0, lambda s: s["time"])
press("space")
s = until("after a drag in a plot the keys of time change nothing else",
          lambda s: s["views"] == views and s["time"] > 0, lambda s: s["time"])
press("space")
press("End")
until("End after a drag in a plot", lambda s: near(s["time"], 0.69, 1e-9), lambda s: s["time"])
press("Escape")
s = until("Esc clears the brush", lambda s: s["selection"]["brushes"] == [], lambda s: s["selection"]["brushes"])

# Transfer function, layers, numbers.
opacity = opacities(s)
drag((1327, 848), (1327, 808))
s = until("a point of the opacity curve dragged upwards becomes more opaque",
          lambda s: near(opacities(s)[1] - opacity[1], 40 / 205, 0.02), opacities)
later = opacities(s)
check("and no other point", [later[0], *later[2:]] == [opacity[0], *opacity[2:]], later)
time.sleep(0.2)
xdo("key", "ctrl+z")
s = until("undo of the curve", lambda s: opacities(s) == opacity, opacities)
press("ctrl+shift+z")
s = until("redo of the curve", lambda s: opacities(s) == later, opacities)
click((1220, 68))
s = until("a click on a tab within a pane shows its task", lambda s: s["views"]["layers"]["task"] == "layers",
          lambda s: s["views"]["layers"])
click((1208, 97))
s = until("the eye hides its layer", lambda s: [layer["visible"] for layer in s["layers"]] == [False, False],
          lambda s: [layer["visible"] for layer in s["layers"]])
apart()
click((1208, 97))
s = until("and shows it again", lambda s: s["layers"][0]["visible"] and not s["layers"][1]["visible"])
density = s["layers"][0]["technique"]["density"]
drag((1401, 363), (1447, 363))
s = until("a slider dragged to the right grows", lambda s: s["layers"][0]["technique"]["density"] > 1.5 * density,
          lambda s: s["layers"][0]["technique"]["density"])

# Panes, menus, the palette.
click((1284, 36))
s = until("a click on a tab shows its pane", lambda s: s["dock"]["root"]["children"][1]["children"][0]["active"] == 1)
share = lambda s: s["dock"]["root"]["children"][0]["children"][0]["ratio"]
ratio = share(s)
drag((626, 300), (688, 300))
s = until("a splitter dragged to the right widens the pane at its left",
          lambda s: near(share(s) - ratio, 62 / 1185, 0.01), share)
click((32, 36), times=2)
s = until("a double click on a tab maximises its pane", lambda s: s["dock"]["maximised"] == "volume",
          lambda s: s["dock"]["maximised"])
press("F11", at=VOLUME)
s = until("F11 takes that back", lambda s: s["dock"]["maximised"] == "", lambda s: s["dock"]["maximised"])
palette("light theme")
s = until("the palette runs what is typed", lambda s: s["appearance"]["theme"] == "light",
          lambda s: s["appearance"]["theme"])

# Layouts one after the other: a brush of the user's own stays, those of a layout go with it. In each, what it is for.
palette("layout: overview")
before = save()
drag((x0 + 15, y0 + 10), (x0 + 45, y0 + 30))
s = until("a brush of one's own", lambda s: len(s["selection"]["brushes"]) == 1, brushes)
mine = brushes(s)
palette("layout: focus")
until("beside it the brush of a layout is off", lambda s: brushes(s) == [*mine, "hot and starved off"], brushes)
palette("layout: lens")
s = until("and goes with its layout", lambda s: brushes(s) == mine and len(s["lenses"]) == 2, brushes)
lenses = s["lenses"]
drag(LENS, (LENS[0] - 60, LENS[1] - 12), modifier="alt")
s = until("Alt and a drag move the lens", lambda s: s["lenses"][0]["center"][2] < lenses[0]["center"][2] - 1e-3,
          lambda s: [each["center"] for each in s["lenses"]])
check("and its settings are in front", s["views"]["layers"]["task"] == "lenses", s["views"]["layers"])
xdo("mousemove", LENS[0] - 60, LENS[1] - 12, "keydown", "alt", "click", 4, "keyup", "alt")
until("Alt and the wheel make it larger", lambda s: s["lenses"][0]["size"][0] > lenses[0]["size"][0],
      lambda s: [each["size"] for each in s["lenses"]])
for name, shows in (("shadowCube", "shadowCube"), ("tesseract", "tesseract"), ("charcoal", "volume")):
    palette("layout: " + name)
    until(f"the layout {name} shows its view, and keeps the brush",
          lambda s: shows in [view["type"] for view in s["views"].values()] and s["views"] != before["views"] and
          brushes(s)[:1] == mine, lambda s: [sorted(s["views"]), brushes(s)])
last = save()
for key in ("ctrl+z", "ctrl+shift+z"):
    for _ in range(15):
        xdo("key", key)
        time.sleep(0.1)

# Which tab is in front within a pane is no edit: what an undo brings back may have turned to another one.
edited = lambda s: {**{part: s[part] for part in ("camera", "selection", "layers", "lenses", "dock")},
                    **{pane: {key: view[key] for key in view if key != "task"} for pane, view in s["views"].items()}}
until("15 undos and 15 redos lead back", lambda s: edited(s) == edited(last),
      lambda s: [part for part in edited(s) if edited(s)[part] != edited(last).get(part)])

sys.exit(1 if failures else 0)
