"""A session as an SVG: its states as lanes, the felt force and the legs over time, and a mark for each plug that was pulled."""

from html import escape

STATES = ["engaged", "engaging", "frozen", "disengaging", "neutral", "homing", "parking", "settled"]
COLOURS = {"engaged": "#009e73", "engaging": "#56b4e9", "frozen": "#0072b2", "disengaging": "#e69f00"}
LEGS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]
LEFT, RIGHT, WIDTH = 110, 945, 960
LANES, LANE = 46, 17
FORCES, LENGTHS, HEIGHT = (206, 336), (366, 496), 130
POINTS = 900
GAP = 0.3  # s without frames that a curve does not bridge


def curve(times, values, x, y, colour):
    """A curve of at most POINTS points, broken where no frames came."""
    thinned = max(1, len(times) // POINTS)
    parts, last = [[]], None
    for k in range(0, len(times), thinned):
        if last is not None and times[k] - last > GAP + thinned * 0.01:
            parts.append([])
        parts[-1].append(f"{x(times[k]):.1f},{y(values[k]):.1f}")
        last = times[k]
    return "".join(f'<polyline points="{" ".join(part)}" stroke="{colour}"/>\n' for part in parts)


def panel(top, bottom, low, high, ticks, title, unit):
    """A frame with an axis, and the place of a value."""

    def y(value):
        return bottom - (value - low) / (high - low) * (bottom - top)

    lines = [f'<rect class="frame" x="{LEFT}" y="{top}" width="{RIGHT - LEFT}" height="{bottom - top}"/>']
    for tick in ticks:
        lines.append(f'<line class="grid" x1="{LEFT}" x2="{RIGHT}" y1="{y(tick):.1f}" y2="{y(tick):.1f}"/>')
        lines.append(f'<text class="e" x="{LEFT - 6}" y="{y(tick) + 4:.1f}">{tick:g}</text>')
    middle = (top + bottom) / 2
    lines.append(f'<text x="10" y="{middle - 6}">{title}</text><text class="unit" x="10" y="{middle + 10}">{unit}</text>')
    return "\n".join(lines) + "\n", y


def draw(rows, states, plugs):
    """`rows` of a time and the numbers of a frame, `states` of a time and a name, `plugs` of a time and a name."""
    times, numbers = [row[0] for row in rows], [row[1] for row in rows]
    end = states[-1][0]

    def x(time):
        return LEFT + time / end * (RIGHT - LEFT)

    out = []
    for k, state in enumerate(STATES):
        out.append(f'<text class="e" x="{LEFT - 6}" y="{LANES + LANE * k + 12}">{state}</text>')
        out.append(f'<line class="grid" x1="{LEFT}" x2="{RIGHT}" y1="{LANES + LANE * k + 8}" y2="{LANES + LANE * k + 8}"/>')
    for (begin, state), (until, _) in zip(states, states[1:]):
        if state in STATES:
            top, colour = LANES + LANE * STATES.index(state) + 2, COLOURS.get(state, "#777")
            out.append(f'<rect x="{x(begin):.1f}" y="{top}" width="{max(1.5, x(until) - x(begin)):.1f}" height="{LANE - 5}" fill="{colour}"/>')
    largest = max(abs(row[k]) for row in numbers for k in (18, 19))
    reach = next(bound for bound in (1, 2, 3, 5, 10) if bound >= largest)
    frame, y = panel(*FORCES, -reach, reach, (-reach, 0, reach), "felt force", "m/s²")
    out.append(frame)
    for k, name, colour in ((18, "surge", "#d55e00"), (19, "sway", "#0072b2")):
        out.append(curve(times, [row[k] for row in numbers], x, y, colour))
        out.append(f'<text x="{RIGHT - 120 + 65 * (k - 18)}" y="{FORCES[0] - 5}" style="fill:{colour}">{name}</text>')
    frame, y = panel(*LENGTHS, 0.95, 1.65, (1.0, 1.3, 1.6), "six legs", "m")
    out.append(frame)
    for k, colour in enumerate(LEGS):
        out.append(curve(times, [row[k] for row in numbers], x, y, colour))
    bottom = LENGTHS[1]
    step = next(step for step in (1, 2, 5, 10, 20, 50, 100, 200) if end / step <= 15)
    for k in range(int(end / step) + 1):
        out.append(f'<text class="m" x="{x(k * step):.1f}" y="{bottom + 16}">{k * step}</text>')
    out.append(f'<text class="e" x="{RIGHT}" y="{bottom + 32}">time in s</text>')
    places, rows_of_text = [], (len(plugs) + 1) // 2
    for k, (time, name) in enumerate(plugs, 1):
        # Marks that stand beside each other.
        place = max(x(time), places[-1] + 17 if places else LEFT)
        places.append(place)
        out.append(f'<line class="mark" x1="{x(time):.1f}" x2="{x(time):.1f}" y1="34" y2="{bottom}"/>')
        out.append(f'<circle cx="{place:.1f}" cy="22" r="8"/><text class="number" x="{place:.1f}" y="26">{k}</text>')
        column, row = divmod(k - 1, rows_of_text)
        out.append(f'<text x="{LEFT + 420 * column}" y="{bottom + 54 + 18 * row}"><tspan font-weight="bold">{k}</tspan>  {escape(name)}</text>')
    height = bottom + 62 + 18 * rows_of_text
    style = (
        "text{fill:#111}.e{text-anchor:end}.m{text-anchor:middle}.unit{font-size:11px;fill:#444}.frame{fill:none;stroke:#888}"
        ".grid{stroke:#ddd}.mark{stroke:#999;stroke-dasharray:3 3}polyline{fill:none;stroke-width:1.3;stroke-linejoin:round}"
        "circle{fill:#333}.number{fill:#fff;text-anchor:middle;font-size:11px}"
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" font-family="sans-serif" font-size="13">\n'
        f"<title>States, felt force and legs of a session in which each plug is pulled once</title>\n<style>{style}</style>\n"
        f'<rect width="{WIDTH}" height="{height}" fill="#fff"/>\n' + "\n".join(out) + "\n</svg>\n"
    )
