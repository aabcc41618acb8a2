"use strict";
// Where the time goes: one bar per coding, from the certified bound up to the motion of a swarm.

const SHARES = {bound: "green", proof: "soft", path: "blue", timing: "sky", family: "blue",
                synchronisation: "orange", optimiser: "red"};

charts.split = (figure, found) => {
  const small = narrow(figure);
  const traces = Object.keys(SHARES).map((share) => {
    const mine = found.bars.filter((bar) => share in bar.shares);
    return {type: "bar", orientation: "h", name: found.meanings[share] ? fold(`${share}: ${found.meanings[share]}`, small ? 40 : 100) : share,
            y: mine.map((bar) => text(bar.name)), x: mine.map((bar) => bar.shares[share]),
            text: mine.map((bar) => bar.shares[share].toPrecision(3)), textposition: "inside", insidetextanchor: "middle",
            insidetextfont: {color: colour("paper")}, constraintext: "inside",
            hovertemplate: `${share}: %{x:.6f} s<extra></extra>`, marker: {color: colour(SHARES[share]), line: {color: colour("paper"), width: 1}}};
  }).filter((trace) => trace.x.length);
  plot(figure, traces, layout({
    barmode: "stack", height: 170 + 50 * found.bars.length, showlegend: true,
    margin: {l: 10, r: 10, t: 10, b: 40},
    xaxis: {title: {text: "time [s]"}}, yaxis: {autorange: "reversed"},
    legend: {x: 0, y: 1.02, yanchor: "bottom"},
  }));
};
