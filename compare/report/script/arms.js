"use strict";
// Every arm on one axis, in units of the best motion of its family.

const MARKS = {
  fastest: ["blue", "circle", "fastest motion known"],
  family: ["green", "diamond", "best of its family"],
  swarm: ["purple", "circle-open", "best swarm"],
  broken: ["red", "x", "published, breaks limits"],
  kept: ["ink", "square", "published, keeps its limits"],
  unjudged: ["ink", "square-open", "published, prints no limits"],
  slowed: ["orange", "square", "published, slowed down to keep them"],
};

charts.arms = (figure, found) => {
  const names = found.lines.map((line) => text(line.case));
  const traces = Object.entries(MARKS).map(([kind, [tint, symbol, words]]) => {
    const mine = found.lines.flatMap((line) => line.marks.filter((mark) => mark.kind === kind).map((mark) => [line, mark]));
    return {type: "scatter", mode: "markers", name: words, x: mine.map(([, mark]) => mark.ratio), y: mine.map(([line]) => text(line.case)),
            hovertemplate: mine.map(([line, mark]) => `${text(line.case)}: ${text(mark.words)}<br>${mark.seconds.toFixed(4)} s, %{x:.4g} × the best of its family<extra></extra>`),
            marker: {color: colour(tint), symbol, size: kind === "swarm" ? 17 : 12, line: {width: 2, color: colour(tint)}}};
  }).filter((trace) => trace.x.length);
  const shapes = found.lines.flatMap((line, k) => {
    const band = (x0, x1, tint) => ({type: "rect", x0, x1, y0: k - 0.38, y1: k + 0.38, layer: "below", fillcolor: colour(tint), line: {width: 0}});
    const barrier = line.barrier ?? 0;
    return [band(0, barrier, "never"), band(barrier, 1, "nospline")];
  });
  const most = Math.max(1.1, ...found.lines.flatMap((line) => line.marks.map((mark) => mark.ratio)));
  plot(figure, traces, layout({
    height: 130 + 46 * names.length, showlegend: true, shapes, hovermode: "closest",
    xaxis: {title: {text: fold("total time, in units of the best motion of its family", narrow(figure) ? 30 : 120)}, range: [0, 1.05 * most], showgrid: false},
    yaxis: {type: "category", categoryorder: "array", categoryarray: names, range: [names.length - 0.5, -0.5], showgrid: false},
    legend: {x: 0, y: 1.02, yanchor: "bottom"},
  }));
};
