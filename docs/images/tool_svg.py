"""Draws docs/images/tool.svg, the words of docs/concepts.md: python3 docs/images/tool_svg.py > docs/images/tool.svg

An arc of 3.2 m with eleven links instead of 33, gaps drawn ten times as wide as they are.
"""

from math import cos, pi, radians, sin

RADIUS, LINKS = 320, 11  # drawn units: 100 are a metre
TOP = (90, 60)  # kick-off; the arc's centre is RADIUS to its right


def at(angle_deg, offset=0):
    """A point of the bore by inclination; offset to the outside of the curve."""
    angle = radians(angle_deg)
    r = RADIUS + offset
    return TOP[0] + RADIUS - r * cos(angle), TOP[1] + r * sin(angle)


def arc(offset, extra=""):
    (x0, y0), (x1, y1) = at(0, offset), at(90, offset)
    r = RADIUS + offset
    return f'<path d="M{x0:.1f} {y0:.1f} A{r} {r} 0 0 0 {x1:.1f} {y1:.1f}" fill="none" {extra}/>'


def text(x, y, words, anchor="start"):
    return f'<text x="{x:.0f}" y="{y:.0f}" text-anchor="{anchor}">{words}</text>'


def pointer(x0, y0, x1, y1):
    return f'<line x1="{x0:.0f}" y1="{y0:.0f}" x2="{x1:.0f}" y2="{y1:.0f}" stroke="#888" stroke-width="0.8"/>'


parts = [
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 640 430" font-family="sans-serif" font-size="13" fill="#222">',
    '<rect width="640" height="430" fill="#fff"/>',
    # rock, guide, pipe
    arc(0, 'stroke="#e8e0d4" stroke-width="58"'),
    arc(0, 'stroke="#fff" stroke-width="44"'),
    arc(17, 'stroke="#0072b2" stroke-width="3"'),
    arc(-17, 'stroke="#0072b2" stroke-width="3"'),
]
points = [at(90 * k / LINKS, 4) for k in range(LINKS + 1)]
parts.append('<polyline points="' + " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
             + '" fill="none" stroke="#444" stroke-width="11" stroke-linejoin="round"/>')
parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4.2" fill="#d55e00"/>' for x, y in points[1:-1]]
bit = points[-1]
parts.append(f'<path d="M{bit[0]:.0f} {bit[1] - 20:.0f} l16 6 v28 l-16 6 z" fill="#666"/>')
# the drive's turn
x, y = points[0]
parts.append(f'<path d="M{x - 22:.0f} {y - 18:.0f} a22 7 0 1 0 44 0" fill="none" stroke="#222" stroke-width="1.5"/>'
             f'<path d="M{x + 22:.0f} {y - 18:.0f} l-6 -1 l7 -7 z"/>')
parts += [
    text(120, 32, "drive: rotary speed"), pointer(112, 38, 128, 34),
    text(150, 64, "kick-off: measured depth 0, inclination 0°"), pointer(122, 60, 146, 60),
    text(190, 118, "wall"), pointer(*at(12, -22), 186, 114),
    text(210, 150, "guide, not driven: carries the weight"), pointer(*at(20, -17), 206, 147),
    text(235, 184, "joint, bends up to its stop"), pointer(*points[4], 231, 181),
    text(262, 218, "link, straight, turns with the drive: carries the torque"),
    pointer((points[5][0] + points[6][0]) / 2, (points[5][1] + points[6][1]) / 2, 258, 216),
    text(310, 252, "gaps: pipe-guide and guide-wall"), pointer(*at(62, -9), 306, 250),
    text(436, 330, "bit: torque, weight"), pointer(424, 368, 440, 336),
    text(436, 410, "inclination 90°"),
    "</svg>",
]
print("\n".join(parts))
