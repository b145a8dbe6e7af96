#!/usr/bin/env python3
"""Wrong cases made from the parts of cases/: two curves swapped, a rim that
does not close, films that cross, walls thicker than their gap, a member of a
family that cannot be. Each ends with the message a user needs: where it is
(file and line, or the films and the place), what is wrong, and what to try.
Where a swap says the same thing, the case simply works."""
import dataclasses
import json
import re
import shlex
import shutil
import sys
import unittest

import program
from program import ProgramTest

sys.path.insert(0, str(program.ROOT / "scripts"))
import cases  # noqa: E402  (scripts/ is found only now)

FILM = 0.005  # areas of films at one resolution, on other triangles
# Sizes at which the rest of a case is still sound, and quick.
COARSE = {
    "constant_mean_curvature": (8, 8), "casting": (24, 24), "talus": (4, 4),
    "bracket_vs_solid": (10, 5), "stepped_shaft": (8, 8),
    "strut_family": (10, 10), "femur": (8, 8), "two_arm": (20, 20),
    "two_arm_sized": (24, 24), "h_beam_casting": (32, 32),
    "bell_crank": (16, 16),
    "spine_crank": (9, 9),
    "fuselage": (200, 200), "minimal_cell": (1.5, 1.5),
    "pressure_vessel": (16, 8), "strut_tubes": (10, 5),
    "torque_tube": (10, 10), "tapered_cantilever": (24, 6),
}
# The mistakes that a case has no room for, and why.
NO_ROOM = {
    "cube_to_sphere": {"crossing": "a liquid that starts inside out turns",
                       "thick": "no walls", "member": "a datafile"},
    "constant_mean_curvature": {"thick": "no walls", "member": "no family"},
    "casting": {"thick": "no walls", "member": "no family"},
    "talus": {"member": "no family"},
    "bracket_vs_solid": {"member": "no family"},
    "stepped_shaft": {"thick": "no walls", "member": "no family"},
    "strut_family": {"thick": "no walls"},
    "femur": {"member": "no family"},
    "fuselage": {"member": "no family"},
    "two_arm": {"thick": "no walls"},
    "two_arm_sized": {"thick": "no walls", "member": "no family"},
    "bell_crank": {"thick": "no walls", "member": "no family"},
    "spine_crank": {"thick": "no walls", "member": "no family"},
    "h_beam_casting": {"member": "no family"},
    "minimal_cell": {"member": "no family"},
    "ge_bracket": {"thick": "no walls", "member": "no family"},
    "torque_tube": {"crossing": "two rings face each other at any length",
                    "member": "no family"},
    "tapered_cantilever": {"thick": "no walls", "member": "no family"},
    "pressure_vessel": {"crossing": "shells may cross: nothing is filled",
                        "thick": "no walls", "member": "no family"},
    "strut_tubes": {"crossing": "shells may cross: nothing is filled",
                    "thick": "no walls"},
}
KINDS = ("swapped", "open", "crossing", "thick", "member")


@dataclasses.dataclass
class Wrong:
    """`replace`: text of the file by other text. `says`: patterns of what is
    printed; {line} is the number of the first line that has `at` in it."""
    kind: str
    what: str
    replace: dict
    exit: int
    says: tuple
    at: str = ""
    command: str = "check case.toml"
    files: dict = dataclasses.field(default_factory=dict)


@dataclasses.dataclass
class Harmless:
    """A swap that means the same: the films' area stays."""
    what: str
    replace: dict
    file: str = "case.toml"


def swapped(one, other):
    """Two texts in each other's place."""
    return {one: "\0", other: one, "\0": other}


def moved(text, replace):
    for old, new in replace.items():
        if old not in text:
            raise AssertionError(f"no {old!r} in the case")
        text = text.replace(old, new, 1)
    return text


def not_closed(body, curve, advice, file="case"):
    return (r"%s\.toml:{line}: body '%s' is not closed at curve '%s': .*%s"
            % (file, body, curve, advice),)


MEMBERS = "name,length,offset,tilt,load\n"
UNSOUND = (r"walls\.\w+ cannot be meshed: the wall may be [\d.e-]+( mm)? "
           r"thick at most near \(.*\) of .\w+., where .*; asked there: "
           r"[\d.]+( mm)?; make the wall thinner there")
CROSS = r"(crosses or overlaps|films cross or fold over there)"
MEET = "surfaces must not meet but at their common edges"

WRONG = {
    "cube_to_sphere": [
        Wrong("swapped", "two edges of a face", {"1  1 2 3\n": "1  1 3 2\n"}, 2,
              (r"cube\.fe:{line}:\d+: face 1 does not close: edge 1 ends at "
               r"vertex 4, edge 3 starts at vertex 3",), "1  1 3 2",
              "evolve cube.fe"),
        Wrong("swapped", "the ends of an edge", {"4  3 2\n": "4  2 3\n"}, 2,
              (r"cube\.fe:\d+:\d+: face 2 does not close: edge -3 ends at "
               r"vertex 3, edge 4 starts at vertex 2",), "",
              "evolve cube.fe"),
        Wrong("swapped", "a face's two sides",
              {"12  -18 -16 -1": "12  1 16 18"}, 2,
              (r"cube\.fe:{line}:\d+: body 1: faces \d+ and 12 run along edge "
               r"\d+ the same way, so one of them is inside out; give it the "
               r"other sign",), "volume 1", "evolve cube.fe"),
        Wrong("open", "a face that the body lacks",
              {" 11 12  volume": " 11  volume"}, 2,
              (r"cube\.fe:{line}:\d+: body 1 is not closed: only its face \d+ "
               r"is at edge \d+, which nothing holds",), "volume 1",
              "evolve cube.fe"),
        Wrong("open", "a face that is not there",
              {"12  -18 -16 -1\n": "", " 11 12  volume": " 11  volume"}, 2,
              (r"cube\.fe:{line}:\d+: body 1 is not closed: only its face \d+ "
               r"is at edge 1, which nothing holds; add the face that is "
               r"missing",), "volume 1", "evolve cube.fe"),
        Harmless("two corners", swapped("1  0 0 0\n", "2  1 0 0\n"), "cube.fe"),
    ],
    "constant_mean_curvature": [
        Harmless("a film's two curves",
                 {'["girdle", "crown"]': '["crown", "girdle"]'}),
        Wrong("swapped", "one end of a film",
              {'["collar", "girdle"]': '["collar", "crown"]'}, 2,
              not_closed("neck", "crown", "let film 'unduloid' end at "
                                          "'girdle', not at 'crown'"),
              '"unduloid", "girdle_plate"'),
        Wrong("swapped", "the curves of two caps",
              {'curve = "collar"': 'curve = "\0"',
               'curve = "girdle"': 'curve = "collar"',
               'curve = "\0"': 'curve = "girdle"'}, 2,
              not_closed("shaft", "girdle", r"\(collar_plate\)"),
              '"cylinder", "collar_plate"'),
        Wrong("open", "a chamber without its lid",
              {'"nodoid", "crown_plate"]': '"nodoid"]'}, 2,
              not_closed("bulge", "crown", "add 'crown_plate' to enclosed_by"),
              '"girdle_plate", "nodoid"'),
        Wrong("crossing", "the crown below the girdle",
              {"+ neck_height + bulge_height": "+ bulge_height"}, 3,
              (r"failed: .*'nodoid'.*'unduloid'.* at \(.*\): films cross or "
               r"fold over there, or a body between them is missing",
               "places like it", r"tried( in vain)?: "),
              command="run case.toml"),
    ],
    "casting": [
        Wrong("swapped", "the roots of both arms",
              {'["root_left", "left"]': '["root_right", "left"]',
               '["root_right", "right"]': '["root_left", "right"]'}, 2,
              not_closed("left_arm", "root_left", "let film 'left_skin' end at "
                         "'root_left', not at 'root_right'"),
              'enclosed_by = ["left_skin"'),
        Wrong("swapped", "the ends of both arms, with their pads",
              {'["root_left", "left"]': '["root_left", "right"]',
               '["root_right", "right"]': '["root_right", "left"]',
               'curve = "left"': 'curve = "\0"',
               'curve = "right"': 'curve = "left"',
               'curve = "\0"': 'curve = "right"'}, 3,
              (r"neck of width [\d.]+( mm)? at \(.*\) between "
               r"'(left|right)_skin'",
               r"tried in vain: 1\.3, 1\.7, 2\.2, 0\.75 times the volume of"), command="run case.toml"),
        Wrong("open", "an arm without its pad",
              {'"left_joint", "left_pad"]': '"left_joint"]'}, 2,
              not_closed("left_arm", "left", "add 'left_pad'"),
              'enclosed_by = ["left_skin"'),
        Wrong("open", "a rim that the hub lacks",
              {'"root_mast", "root_nose"]': '"root_nose"]'}, 2,
              not_closed("hub", "root_mast", r"\(mast_joint\), two must"),
              'enclosed_by = ["hub_skin"'),
        Wrong("open", "a rim measured half way round",
              {'kind = "circle"\ncenter = [-88, 0, 4]\nnormal = [-1, 0, 0]\n'
               'radius = 52': 'kind = "file"\nfile = "rim.csv"'}, 0,
              (r"case\.toml:{line}: warning: .*rim\.csv:12: the curve does not "
               r"come back to its first point: 104 mm are left, .* longer than "
               r"16\.\d+ mm; .*are points missing\?",), 'file = "rim.csv"',
              files={"rim.csv": "x,y,z\n" + "".join(
                  f"-88,{52 * c},{4 + 52 * s}\n" for c, s in (
                      (1, 0), (.951, .309), (.809, .588), (.588, .809),
                      (.309, .951), (0, 1), (-.309, .951), (-.588, .809),
                      (-.809, .588), (-.951, .309), (-1, 0)))}),
        Wrong("crossing", "the mast's end within the hub",
              {"center = [30, 20, 210]": "center = [30, 20, 20]"}, 3,
              (r"failed: .*'hub_skin'.*'mast_skin'.* at \(.*\): .*" + CROSS,),
              command="run case.toml"),
        Wrong("crossing", "an arm that turns back",
              {"center = [-215, 0, 20]\nnormal = [-1, 0, 0]":
               "center = [-60, 0, -160]\nnormal = [0, 0, -1]"}, 2,
              (r"case\.toml:{line}: film 'left_skin': curve 'root_left' is off "
               r"the convex hull .* near \(.*\).*move or turn the curve",),
              "[films.left_skin]", "run case.toml"),
    ],
    "talus": [
        Harmless("a ring's two curves",
                 {'curve = "trochlea"\ninner = "trochlea_middle"':
                  'curve = "trochlea_middle"\ninner = "trochlea"'}),
        Wrong("swapped", "rims of two foliates",
              {'["trochlea_middle", "head_middle",':
               '["trochlea_middle", "head_inner",'}, 2,
              not_closed("shell", "head_inner", "let film 'middle' end at "
                         "'head_middle', not at 'head_inner'"),
              ""),
        Wrong("swapped", "two points of a rim",
              swapped("[5.5, 13.5, 15.5]", "[-6.0, 14.0, 15.5]"), 2,
              (r"case\.toml:{line}: curve 'trochlea': crosses or touches "
               r"itself near \(.*\).*points must follow each other",),
              "[curves.trochlea]"),
        Wrong("open", "the hollow without a lid",
              {'"trochlea_lid", "head_lid", "calcaneal_lid"]':
               '"trochlea_lid", "head_lid"]'}, 2,
              not_closed("hollow", "calcaneal_inner", "add 'calcaneal_lid'"),
              '"inner", "trochlea_lid"'),
        Wrong("open", "a rim of two points",
              {" [5.5, 13.5, 15.5], [-6.0, 14.0, 15.5], [-17.5, 9.6, 15.5],\n":
               "\n", "[-20.6, 0, 15.5], [-17.5, -9.6, 15.5], "
               "[-6.0, -14.0, 15.5], [5.5, -13.5, 15.5],":
               "[-20.6, 0, 15.5],"}, 2,
              (r"case\.toml:{line}: curve 'trochlea': spline has 2 points, "
               r"must have 3 or more\n\Z",), "[curves.trochlea]"),
        Wrong("crossing", "the inner rim of the head moved up",
              {'of = "head"\nscale = "inner_scale"\nabout = ["cx", "cy", "cz"]':
               'of = "head"\nscale = "inner_scale"\n'
               'about = ["cx", "cy", "cz + 16"]'}, 3,
              (r"failed: .*\('inner'\) crosses or overlaps another with facet "
               r"\d+ \('middle'\) at \(.*\): " + MEET,
               "places like it"), command="run case.toml"),
        Wrong("thick", "foliates in the wrong order",
              {"initial = 0.72\nbounds = [0.64, 0.78]":
               "initial = 0.9\nbounds = [0.64, 0.95]"}, 2,
              (r"case\.toml:{line}: bodies\.core\.volume is -[\d.]+ where "
               r"inner_scale = 0\.9, .*middle_scale = 0\.86; it must be above "
               r"0",), 'volume = "volume * (middle_scale^3 - inner_scale^3)"'),
    ],
    "bracket_vs_solid": [
        Harmless("the skin's two curves",
                 {'["foot_rim", "pad_rim"]': '["pad_rim", "foot_rim"]'},
                 "skin.toml"),
        Wrong("swapped", "lid and mouth",
              {'kind = "disk"\ncurves = ["pad_rim"]':
               'kind = "disk"\ncurves = ["foot_rim"]',
               'kind = "cap"\ncurve = "foot_rim"':
               'kind = "cap"\ncurve = "pad_rim"'}, 2,
              (r"skin\.toml:{line}: there is no surface 'skin/rim:foot_rim'; "
               r"did you mean 'skin/rim:pad_rim'",), "supports = [",
              "check skin.toml"),
        Wrong("swapped", "two corners of the H",
              swapped('["back", "-rw", 0]', '["r2", "-rw", 0]'), 2,
              (r"plates\.toml:{line}: curve 'root': crosses or touches itself "
               r"near \(.*\)",), "[curves.root]", "check plates.toml"),
        Wrong("open", "the liquid without its mouth",
              {'["skin", "lid", "mouth"]': '["skin", "lid"]'}, 2,
              not_closed("inside", "foot_rim", "add 'mouth' to", "skin"),
              'enclosed_by = ["skin", "lid"]', "check skin.toml"),
        Wrong("open", "the plates without the column",
              {'"foot", "column", ': '"foot", '}, 2,
              (r"plates\.toml:{line}: body 'part' is not closed at the side "
               r"from \(.*\) to \(.*\) of curve 'root' and 11 more of its "
               r"sides: 1 of its surfaces meets there \(foot\), expected "
               r"two; "
               r"add 'column' to enclosed_by",), 'enclosed_by = ["foot"',
              "check plates.toml"),
        Wrong("crossing", "a column wider than the top plate", {}, 3,
              (r"'column'.*crosses or overlaps another with facet \d+ "
               r"\('top_face'\)",),
              command="run plates.toml --set study.kind=analyse "
                      "--set head_width=50 "
                      "--set design.head_width.bounds=[20,60]"),
        Wrong("thick", "a wall that leaves no pad", {}, 2,
              (r"skin\.toml:{line}: curve 'pad_rim': corner_radius is 14, must "
               r"be 0 or more and below half the shorter side, 7 where .*"
               r"rim = 14",), "[curves.pad_rim]",
              "check skin.toml --set wall=30 "
              "--set design.wall.bounds=[3,40]"),
        Wrong("thick", "flanges that meet each other", {}, 2,
              (r"plates\.toml:{line}: curve 'root': points 2 and 3 are equal at "
               r"\(10, -2, 0\).* where .*r2 = 10, r3 = 10",), "[curves.root]",
              "check plates.toml --set flange=40 "
              "--set design.flange.bounds=[3,50]"),
    ],
    "stepped_shaft": [
        Harmless("a film's two curves",
                 {'["shoulder", "neck"]': '["neck", "shoulder"]'}),
        Wrong("swapped", "one end of the thick cylinder",
              {'["big_rim", "shoulder"]': '["big_rim", "neck"]'}, 2,
              not_closed("shaft", "neck", "let one of them end where one is "
                                          "missing, as at 'shoulder'"),
              'enclosed_by = ["big_side"'),
        Wrong("open", "no cap at the small end",
              {'"big_end", "small_end"]\npressure':
               '"big_end"]\npressure'}, 2,
              not_closed("shaft", "small_rim", "add 'small_end'"),
              'enclosed_by = ["big_side"'),
        Wrong("crossing", "the big end inside the shaft", {}, 3,
              (r"'small_side'.*crosses or overlaps another with facet \d+ "
               r"\('big_end'\) at \(.*\): " + MEET,),
              command="run case.toml --set study.kind=analyse --set low=20"),
    ],
    "pressure_vessel": [
        Harmless("a film's two curves",
                 {'["seat", "neck"]\n\n[films.bottom]':
                  '["neck", "seat"]\n\n[films.bottom]'}),
        Wrong("swapped", "one end of a film",
              {'["neck", "top"]': '["seat", "top"]'}, 2,
              not_closed("pipe", "neck", "let film 'nozzle' end at 'neck', not "
                                         "at 'seat'"),
              'enclosed_by = ["nozzle"'),
        Wrong("open", "the gas without a lid",
              {'"bottom", "neck_lid"]': '"bottom"]'}, 2,
              not_closed("gas", "neck", "add 'neck_lid'"),
              'enclosed_by = ["wall"'),
    ],
    "strut_tubes": [
        Harmless("both films' curves",
                 {'curves = ["foot", "eye"]\n\n[films':
                  'curves = ["eye", "foot"]\n\n[films',
                  '["eye", "end"]': '["end", "eye"]'}),
        Wrong("swapped", "the rims of a thickness",
              {'curves = ["foot", "eye"]\ncounts':
               'curves = ["foot", "end"]\ncounts'}, 2,
              (r"case\.toml:{line}: shells\.tube\.thickness has a shape "
               r"between curves 'foot' and 'end'; no film of .*tube ends at "
               r"'end' \(they end at eye, foot\)",), 'thickness = "thickness"',
              "run case.toml --set study.kind=analyse"),
        Wrong("open", "the end without its lid",
              {'"joint", "eye_pad"]': '"joint"]'}, 2,
              not_closed("boss", "end", "add 'eye_pad'"),
              'enclosed_by = ["boss_side"'),
        Wrong("member", "a length below 0", {'"members.csv"': '"m.csv"'}, 2,
              (r"m\.csv:3: member 'b': .*case\.toml:{line}: "
               r"bodies\.part\.volume is -67971\.8 where .*length = -60; it "
               r"must be above 0",),
              'volume = "fill * length', "run case.toml",
              {"m.csv": MEMBERS + "a,70,8,10,2000\nb,-60,0,0,2000\n"}),
    ],
    "torque_tube": [
        Harmless("the film's curves",
                 {'["low", "high"]': '["high", "low"]'}),
        Wrong("swapped", "the ends of the load", {
            '[{ on = "skin/rim:high", by': '[{ on = "skin/rim:hihg", by'}, 2,
              (r"case\.toml:{line}: there is no surface 'skin/rim:hihg'; did "
               r"you mean 'skin/rim:high'",), "loads = ["),
        Wrong("open", "the gas without an end",
              {'["skin", "low_end", "high_end"]': '["skin", "low_end"]'}, 2,
              not_closed("gas", "high", "add 'high_end'"),
              'enclosed_by = ["skin"'),
        Wrong("thick", "walls thicker than the ring's radius", {}, 3,
              (UNSOUND,),
              command="run case.toml --set study.kind=analyse "
                      "--set design.wall.initial=120 "
                      "--set design.wall.bounds=[1,150]"),
    ],
    "tapered_cantilever": [
        Harmless("a film's two curves",
                 {'["rim_{i}", "rim_{i + 1}"]': '["rim_{i + 1}", "rim_{i}"]'}),
        Wrong("swapped", "the wall of another chamber",
              {'["skin_{i}", "wall_{i}", "wall_{i + 1}"]':
               '["skin_{i}", "wall_{i}", "wall_{13 - i}"]'}, 2,
              (r"case\.toml:{line}: body 'chamber_1' is not closed at curve "
               r"'rim_2'",), 'enclosed_by = ["skin'),
        Wrong("open", "chambers without a wall",
              {'["skin_{i}", "wall_{i}", "wall_{i + 1}"]':
               '["skin_{i}", "wall_{i}"]'}, 2,
              not_closed("chamber_1", "rim_2", "add 'wall_2'"),
              'enclosed_by = ["skin'),
        Wrong("crossing", "a chamber that turns back", {
            'center = [0, 0, "length * (1 - ((chambers + 1 - i) / '
            'chambers)^1.5)"]':
            'center = [0, 0, "length * (1 - ((chambers + 1 - i) / '
            'chambers)^1.5) - 300 * (i == 13)"]'}, 3,
              (r"\('skin_12'\)|'skin_12'",),
              command="run case.toml --set study.kind=analyse"),
    ],
    "strut_family": [
        Harmless("both films' curves",
                 {'["foot", "eye"]': '["eye", "foot"]',
                  '["eye", "end"]': '["end", "eye"]'}),
        Wrong("swapped", "the film's upper rim",
              {'["foot", "eye"]': '["foot", "end"]'}, 2,
              not_closed("part", "eye", "let film 'skin' end at 'eye', not at "
                                        "'end'"),
              'enclosed_by = ["skin"'),
        Wrong("swapped", "an eye of another strut",
              {'curves = ["foot_1", "eye_1"]': 'curves = ["foot_1", "eye_2"]'},
              2, (r"variants\.toml:{line}: body 'strut_1' is not closed at "
                  r"curve 'eye_1'.*let film 'skin_1' end at 'eye_1', not at "
                  r"'eye_2'",),
              'enclosed_by = ["skin_1"', "check variants.toml"),
        Wrong("open", "the end without its lid",
              {'"joint", "eye_pad"]': '"joint"]'}, 2,
              not_closed("boss", "end", "add 'eye_pad'"),
              'enclosed_by = ["boss_side"'),
        Wrong("crossing", "an end that leans back into the strut", {}, 3,
              (r"('boss_side'.*'skin'|'skin'.*'boss_side').* at \(.*\): .*" +
               CROSS,),
              command="run case.toml --set study.kind=analyse --set tilt=170"),
        Wrong("crossing", "three struts on one foot", {"gap = 0.05": "gap = 0"},
              2, (r"variants\.toml:\d+: solids 'pad_1' and 'pad_3' lie on each "
                  r"other, both across curve 'foot_1'; .*give the other a "
                  r"curve of its own",), "", "check variants.toml"),
        Wrong("member", "a length below 0", {'"members.csv"': '"m.csv"'}, 2,
              (r"m\.csv:3: member 'b': .*case\.toml:{line}: "
               r"bodies\.part\.volume is -67971\.8 where .*length = -60; it "
               r"must be above 0",),
              'volume = "fill * length', "run case.toml",
              {"m.csv": MEMBERS + "a,70,8,10,2000\nb,-60,0,0,2000\n"}),
        Wrong("member", "a sphere smaller than its rim",
              {'"1.25 * head"': '"0.9 * head"'}, 2,
              (r"ball\.toml:{line}: parameters\.rise: sqrt\(-37\.24\) is not a "
               r"finite number .* where head = 14, ball = 12\.6",),
              "rise =", "check ball.toml"),
        Wrong("member", "an end turned away from the strut, and one too long",
              {'"members.csv"': '"m.csv"', 'each = "minimize"':
               'each = "analyse"', 'method = "slsqp"\n': "",
               'objective = "mass"\n': "", 'constraints = [\n  { response = '
               '"deflection", max = 0.1 }, # mm\n  { response = "margin", '
               'min = 2e-4 }, # N/mm3\n]\n': ""}, 3,
              (r"leans: .*case\.toml:{line}: film 'skin': curve 'eye' is off "
               r"the convex hull",
               r"long: .*neck of width [\d.]+( mm)? at \(.*\)",
               r"1 of 3 members are sized; not leans \(failed\), long "
               r"\(failed\)"), "[films.skin]", "run case.toml",
              {"m.csv": MEMBERS + "good,70,8,10,2000\nleans,70,8,100,2000\n"
                                  "long,300,0,0,2000\n"}),
        Wrong("member", "a load that no design bears",
              {'"members.csv"': '"m.csv"', 'method = "slsqp"':
               'method = "slsqp"\nmax_evaluations = 6'}, 3,
              (r"b: .*'deflection' is [\d.]+( mm)? and must be at most 0\.1",
               "[Ll]oosen one of these"), "", "run case.toml",
              {"m.csv": MEMBERS + "b,70,8,10,400000\n"}),
    ],
    "femur": [
        Wrong("swapped", "two lengths of the shaft",
              {'["shaft_1", "shaft_2"]': '["shaft_1", "shaft_3"]',
               '["shaft_2", "shaft_3"]': '["shaft_2", "shaft_1"]'}, 2,
              not_closed("wall2", "shaft_3", "let film 'shaft2' end at "
                         "'shaft_2', not at 'shaft_3'"),
              'enclosed_by = ["shaft2"'),
        Wrong("open", "the tip without its ring",
              {'"trochanter_lid", "trochanter_wall"]\nvolume = 2800':
               '"trochanter_lid"]\nvolume = 2800'}, 2,
              not_closed("tip_core", "trochanter", "add 'trochanter_wall'"),
              'enclosed_by = ["tip"'),
        Wrong("crossing", "condyles too near each other", {}, 2,
              (r"case\.toml:{line}: curves 'inner_condyle' and 'outer_condyle' "
               r"meet near \(.*\) where condyle_apart = 10",),
              "[curves.outer_condyle]",
              "check case.toml --set condyle_apart=10"),
        Wrong("crossing", "the canal beside the shaft",
              {'about = [0, "y3", "z0 - 3 * step"]':
               'about = [0, "y3", "z0 - 3 * step"]\nmove = [10, 0, 0]'}, 2,
              (r"case\.toml:{line}: curves 'shaft_3' and 'shaft_3_in' meet "
               r"near \(.*\)",), "[curves.shaft_3_in]"),
        Wrong("thick", "a canal wider than the shaft", {}, 2,
              (r"case\.toml:{line}: bodies\.wall3\.volume is -[\d.]+ where "
               r"canal = 1\.05, .*; it must be above 0",),
              'volume = "pi * step * (2 * r2 * r2 + 2 * r3 * r3',
              "check case.toml --set canal=1.05 "
              "--set design.canal.bounds=[0.5,1.1]"),
        Wrong("thick", "a head smaller than its rim", {}, 2,
              (r"case\.toml:{line}: parameters\.d1: sqrt\(-50\.25\) is not a "
               r"finite number .* where head_radius = 16, head_rim = 17\.5",),
              "d1 = ", "check case.toml --set head_radius=16"),
    ],
    "fuselage": [
        Wrong("swapped", "the far rim of the stiffeners around",
              {'_{j}_4"]': '_{j}_5"]'}, 2,
              not_closed("lattice", "rim_10_1_5", "let one of them end where "
                         "one is missing, as at 'rim_10_1_4'"),
              "", "check case.toml --set bays_around=10 "
                                 "--set bays_along=3"),
        Wrong("open", "windows that the cabin lacks",
              {'  { name = "pane_up_{i}_{j}", repeat = ["bays_around", '
               '"bays_along"] },\n': ""}, 2,
              not_closed("cabin", "up_1_1", "add 'pane_up_1_1'"), "",
              "check case.toml --set bays_around=10 --set bays_along=3"),
        Wrong("crossing", "stiffeners wider than their node", {}, 2,
              (r"case\.toml:{line}: curves 'rim_\w+' and 'rim_\w+' meet near "
               r"\(.*\) where .*films join where they name the same curve",),
              "[curves.rim]", "check case.toml --set tube_share=0.2"),
        Wrong("thick", "a tail that is narrower than nothing", {}, 2,
              (r"case\.toml:{line}: curve 'rear': radius is -609\.\d+, must be "
               r"above 0",), "[curves.rear]", "check case.toml --set tail=1.2"),
    ],
    "two_arm": [
        Harmless("the order of a film's curves",
                 {'["support", "left", "right"]':
                  '["left", "right", "support"]'}),
        Wrong("swapped", "the curve of a pad", {'curve = "left"':
                                                'curve = "right"'}, 2,
              (r"case\.toml:{line}: solids 'left_pad' and 'right_pad' lie on "
               r"each other, both across curve 'right'",),
              "[solids.right_pad]"),
        Wrong("open", "an arm without its pad",
              {'"left_pad", "right_pad"]': '"left_pad"]'}, 2,
              not_closed("part", "right", "add 'right_pad'"),
              "enclosed_by"),
        Wrong("open", "half a circle for a rim",
              {'kind = "circle"\ncenter = ["support_x", 0, 0]\n'
               'normal = [0, 0, -1]\nradius = 35':
               'kind = "polyline"\npoints = [["support_x - 35", 0, 0], '
               '{ through = ["support_x", 35, 0] }]'}, 2,
              (r"case\.toml:{line}: curve 'support': polyline has 2 points, "
               r"must have 3 or more",), "[curves.support]"),
        Wrong("crossing", "the arms' rims cross",
              {"center = [-120, 0, 72]": "center = [-20, 0, 72]",
               "center = [120, 0, 72]": "center = [20, 0, 72]"}, 2,
              (r"case\.toml:{line}: curves 'left' and 'right' meet near "
               r"\(.*\)",), "[curves.right]"),
        Wrong("member", "a member whose arms cannot deflect alike",
              {'kind = "match"\n': 'kind = "family"\neach = "match"\n'
               'members = "m.csv"\n'}, 3,
              (r"b: the best design found stands at a bound: .*support_x at "
               r"its upper bound 40\. Widen the bounds or free another "
               r"variable",
               r"0 of 1 members? (is|are) sized; not b \(infeasible\)"), "",
              "run case.toml",
              {"m.csv": "name,load_left,load_right\nb,40000,4000000\n"}),
    ],
    "two_arm_sized": [
        Wrong("swapped", "the roots of both arms",
              {'["left_root", "left"]': '["right_root", "left"]',
               '["right_root", "right"]': '["left_root", "right"]'}, 2,
              not_closed("left_arm", "left_root", "let film 'left_skin' end at "
                         "'left_root', not at 'right_root'"),
              'enclosed_by = ["left_skin"'),
        Wrong("open", "the hub without a bulkhead",
              {'"left_bulkhead", "right_bulkhead"]': '"left_bulkhead"]'}, 2,
              not_closed("hub", "right_root", "add 'right_bulkhead'"),
              'enclosed_by = ["hub_skin"'),
        Wrong("crossing", "roots that meet", {}, 2,
              (r"case\.toml:{line}: curves 'left_root' and 'right_root' meet "
               r"near \(.*\) where .*reach = 10",), "[curves.right_root]",
              "check case.toml --set reach=10 "
              "--set design.reach.bounds=[5,80]"),
        Wrong("crossing", "roots on the wrong sides", {}, 2,
              (r"case\.toml:{line}: film 'hub_skin': curve 'left_root' is off "
               r"the convex hull",), "[films.hub_skin]",
              "evolve case.toml --set reach=-20 "
              "--set design.reach.bounds=[-30,80]"),
    ],
    "bell_crank": [
        Wrong("swapped", "the tips of both arms",
              {'["a_middle", "a_tip"]': '["a_middle", "b_tip"]',
               '["b_root", "b_tip"]': '["b_root", "a_tip"]'}, 2,
              not_closed("middle_m", "a_tip", "let film 'arm_m' end at "
                         "'a_tip', not at 'b_tip'"),
              'enclosed_by = ["arm_m"'),
        Wrong("open", "a pin's eye without its bore",
              {'["eye_a", "pin_a", "a_tip_cap"]': '["eye_a", "a_tip_cap"]'}, 2,
              not_closed("end_a", "a_front", "add 'pin_a'"),
              'enclosed_by = ["eye_a"'),
        Wrong("crossing", "roots that meet", {}, 2,
              (r"case\.toml:{line}: curves 'a_root' and 'b_root' meet near ",),
              "[curves.b_root]", "check case.toml --set root=12 --set apart=40 "
              "--set high_b=18"),
    ],
    "spine_crank": [
        Wrong("swapped", "bores from one pin to the other",
              swapped('inner = "a_back"', 'inner = "b_back"'), 2,
              (r"case\.toml:{line}: film 'skin': its spines' liquid does not "
               r"reach curve 'a_front'",), "[films.skin]"),
        Wrong("open", "a pin's eye without its bore",
              {'["skin", "pivot", "pin_a", "pin_b"]':
               '["skin", "pivot", "pin_b"]'}, 2,
              not_closed("part", "a_front", "add 'pin_a'"),
              'enclosed_by = ["skin"'),
        Wrong("crossing", "a pin within the pivot's liquid", {}, 2,
              (r"case\.toml:{line}: film 'skin': its spines' liquid does not "
               r"reach curve 'a_front'",), "[films.skin]",
              "check case.toml --set long=15"),
    ],
    "ge_bracket": [
        Wrong("swapped", "the washers' collars and undersides",
              swapped('inner = "sole_{i}"', 'inner = "brow_{i}"'), 2,
              not_closed("part", "sole_1", "add 'sole_1'"),
              'enclosed_by = ["skin"'),
        Wrong("open", "the part without the pin's bores",
              {', { name = "pin_{i}", repeat = 2 }]\npressure': ']\npressure'}, 2,
              not_closed("part", "pin_front_1", "add 'pin_1'"),
              'enclosed_by = ["skin"'),
        Wrong("crossing", "seats that meet", {}, 2,
              (r"case\.toml:{line}: curves 'seat_3' and 'seat_4' meet near "
               r"\(.*other curves must keep apart",), "[curves.seat]",
              "check case.toml --set seat_r=20"),
    ],
    "h_beam_casting": [
        Wrong("swapped", "the rings of both blends",
              {'["ring_{i}", "beam_{i}"]': '["ring_{3 - i}", "beam_{i}"]'}, 2,
              not_closed("arm_1", "ring_1", "add"),
              'enclosed_by = ["blend_{i}"'),
        Wrong("open", "the base without its ground",
              {'"floor_2", "ground"]': '"floor_2"]'}, 2,
              not_closed("base", "foot", "add 'ground'"),
              'enclosed_by = ["shell"'),
        Wrong("crossing", "rings that meet", {}, 2,
              (r"case\.toml:{line}: curves 'ring_1' and 'ring_2' meet near "
               r"\(.*\) where half_spacing = 60",), "[curves.ring]",
              "check case.toml --set half_spacing=60"),
        Wrong("swapped", "webs that join a film of another name",
              {'["blend_{i}", "floor_{i}"]\ntension': '["blend_{i}", "flor_{i}"]\ntension'},
              2, (r"case\.toml:{line}: .*'flor_1'.*floor_1",), "[films.web]"),
        Wrong("crossing", "webs that end amid the flanges",
              {'["(2 * i - 3) * end_x", "depth", "end_z"],\n  ["(2 * i - 3) * half_spacing", "ring_radius"':
               '["(2 * i - 3) * end_x", "depth - 20", "end_z"],\n  ["(2 * i - 3) * half_spacing", "ring_radius"'},
              2, (r"curves 'web_1' and 'inner_end_1' meet near",)),
        Wrong("thick", "walls thicker than the beams", {}, 3, (UNSOUND,),
              command="run case.toml --set skin=160 "
                      "--set design.skin.bounds=[9,200]"),
    ],
    "minimal_cell": [
        Harmless("the way of a wall's normal",
                 {"normal = [0, 0, 1]": "normal = [0, 0, -1]"}),
        Wrong("swapped", "two corners of the rim",
              swapped('[0, "a / 2", "a"]', '["a / 2", 0, "a"]'), 2,
              (r"case\.toml:{line}: no body or wall ends in a plane of symmetry: "
               r".*or at a polygon whose sides lie in planes",),
              "{ at = [0, 0, 0], normal"),
        Wrong("open", "a wall that the void lacks",
              {'"right", "back", "top"]': '"right", "back"]'}, 2,
              (r"case\.toml:{line}: solid 'top' encloses no body; add it to a "
               r"body's enclosed_by",), "[solids.top]"),
        Wrong("crossing", "a wall across the film",
              {'at = ["a", 0, 0]': 'at = ["a / 2", 0, 0]'}, 2,
              (r"case\.toml:{line}: curve 'rim' lies on both sides of the wall "
               r"of 'right'; films lie within the planes on which they slide",),
              "[solids.right]"),
        Wrong("thick", "walls thicker than the bends", {}, 3, (UNSOUND,),
              command="run case.toml --set thickness=12 "
                      "--set design.thickness.bounds=[0.1,20]"),
    ],
}


class WrongCases(ProgramTest):
    def copy(self, name):
        folder = self.folder / name
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(cases.CASES / name, folder)
        return folder

    def command(self, name, text, folder):
        words = shlex.split(text)
        words[1] = str(folder / words[1])
        if words[0] in ("run", "evolve"):
            words += ["--no-pictures", "--out", str(folder / "out")]
        if words[0] == "run":
            words.append("--no-report")
        if name in COARSE and words[0] != "check":
            fea, film = COARSE[name]
            words += ["--set", f"resolution.fea={fea}"]
            words += ["--set", f"resolution.film={film}"]
        return words

    def wrong(self, name, item):
        folder = self.copy(name)
        path = folder / shlex.split(item.command)[1]
        text = moved(path.read_text(encoding="utf-8"), item.replace)
        path.write_text(text, encoding="utf-8")
        for file, content in item.files.items():
            (folder / file).write_text(content, encoding="utf-8")
        line = (self.line_of(path, re.escape(item.at)) if item.at
                else r"\d+")
        done = self.call(*self.command(name, item.command, folder))
        self.expect(done, item.exit, *(
            says.replace("{line}", str(line)) for says in item.says))
        if item.exit == 2:
            self.assertFalse((folder / "out" / "result.json").exists())

    def area(self, name, item, replace):
        folder = self.copy(name)
        path = folder / item.file
        path.write_text(moved(path.read_text(encoding="utf-8"), replace),
                        encoding="utf-8")
        self.expect(self.call(*self.command(
            name, f"evolve {item.file}", folder)), 0)
        return json.loads((folder / "out" / "film.json").read_text())["area"]

    def harmless(self, name, item):
        before = self.area(name, item, {})
        after = self.area(name, item, item.replace)
        self.assertAlmostEqual(after / before, 1, delta=FILM)

    def test_every_case_has_every_mistake(self):
        for folder in cases.folders():
            name = folder.name
            self.assertIn(name, WRONG, "make wrong cases of this one too")
            made = {item.kind for item in WRONG[name]
                    if isinstance(item, Wrong)}
            self.assertEqual(made | set(NO_ROOM[name]), set(KINDS), name)
            self.assertFalse(made & set(NO_ROOM[name]), name)


def add_test(name, items):
    def test(self):
        for item in items:
            with self.subTest(what=item.what):
                if isinstance(item, Harmless):
                    self.harmless(name, item)
                else:
                    self.wrong(name, item)
    setattr(WrongCases, "test_" + name, test)


for case_name, case_items in WRONG.items():
    add_test(case_name, case_items)

if __name__ == "__main__":
    unittest.main(verbosity=2)
