"use strict";
// The ladder: a line per bound, reference and motion; two zones that cannot be reached.

const KINDS = {
  lower: ["blue", "triangle-right", "no motion is faster (proved)"],
  upper: ["green", "circle", "verified motion"],
  reference: ["purple", "diamond", "reference of another program"],
  broken: ["red", "x", "claimed, breaks limits"],
  swarm: ["orange", "square", "swarm, verified"],
  given: ["orange", "square", "given motion"],
  faulty: ["red", "x", "given motion, breaks what is asked for"],
};

charts.ladder = (figure, found) => {
  const every = figure.dataset.every === "yes";
  const lines = found.lines.filter((line) => every || line.first);
  if (lines.length < found.lines.length) {
    controls(figure, () => [tick(`all ${found.lines.length} lines`, false, (on) => {
      figure.dataset.every = on ? "yes" : "";
      draw(figure);
    })]);
  }
  const small = narrow(figure);
  const right = Math.max(...lines.map((line) => line.seconds), found.optimum ?? 0);
  const against = (seconds) => {
    if (!found.optimum) return "";
    const gap = seconds / found.optimum - 1;
    if (Math.abs(gap) < 5e-7) return "";
    return ` (${gap > 0 ? "+" : "−"}${Math.abs(100 * gap).toPrecision(3)} %)`;
  };
  const name = (line) => (small ? fold(line.name, 22) : fold(line.name, 44));
  // the names stand on the left of the plot, the longest time's words on its right
  const inside = widthOf(figure) - (small ? 140 : 270), beside = inside / (inside - (small ? 80 : 150));
  const traces = Object.entries(KINDS).map(([kind, [tint, symbol, words]]) => {
    const mine = lines.filter((line) => line.kind === kind);
    return {
      type: "scatter", mode: "markers+text", name: words,
      x: mine.map((line) => line.seconds), y: mine.map(name),
      text: mine.map((line) => `  ${line.seconds.toFixed(4)} s${small ? "" : against(line.seconds)}`),
      textposition: "middle right", cliponaxis: false,
      hovertemplate: mine.map((line) => `${text(line.name)}<br>${line.seconds.toFixed(6)} s${against(line.seconds)}<extra></extra>`),
      marker: {color: colour(tint), symbol, size: 11},
    };
  }).filter((trace) => trace.x.length);
  const shapes = lines.map((line) => ({
    type: "line", x0: 0, x1: line.seconds, y0: name(line), y1: name(line), layer: "below",
    line: {color: colour(KINDS[line.kind][0]), width: 1},
  }));
  const notes = [];
  const zone = (x0, x1, tint, words) => {
    shapes.unshift({type: "rect", xref: "x", yref: "paper", x0, x1, y0: 0, y1: 1, layer: "below",
                    fillcolor: colour(tint), line: {width: 0}});
    if ((x1 - x0) / right > (small ? 0.55 : 0.22)) {
      notes.push({x: (x0 + x1) / 2, y: 1, xref: "x", yref: "paper", yanchor: "bottom", text: words,
                  showarrow: false, font: {size: 12, color: colour("ink")}});
    }
  };
  if (found.barrier) zone(0, found.barrier, "never", "no motion can be here");
  if (found.optimum && found.optimum > (found.barrier ?? 0)) {
    zone(found.barrier ?? 0, found.optimum, "nospline",
         found.proved ? "no spline of the family" : "no spline known");
  }
  plot(figure, traces, layout({
    height: (small ? 140 : 110) + (small ? 48 : 30) * lines.length, showlegend: true, shapes, annotations: notes,
    margin: {l: 10, r: 10, t: 24, b: 40},
    legend: {orientation: "h", x: 0, xref: "container", y: -0.02, yref: "container", yanchor: "bottom"},
    xaxis: {title: {text: `total time [s]${found.optimum && !small ? "; in brackets: against the best of the family" : ""}`},
            range: [0, right * beside], showgrid: false},
    yaxis: {categoryorder: "array", categoryarray: lines.map(name).reverse(), showgrid: false,
            tickfont: {size: small ? 11 : 13}},
  }));
};

function fold(words, width) {
  const rows = [""];
  // a name without a space may be longer than a row
  for (const word of words.split(" ").flatMap((one) => one.match(new RegExp(`.{1,${width}}`, "gsu")) ?? [""])) {
    if (rows.at(-1).length + word.length > width && rows.at(-1)) rows.push("");
    rows.push(`${rows.pop()} ${word}`.trim());
  }
  return rows.map(text).join("<br>");
}
