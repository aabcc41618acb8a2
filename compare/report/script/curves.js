"use strict";
// Every seed's gap; gaps and shares of targets against evaluations.

const VARIANTS = [["blue", "diamond"], ["red", "square"], ["sky", "circle"], ["orange", "triangle-up"],
                  ["purple", "triangle-down"], ["green", "cross"]];
const SMALLEST = 1e-12;  // smaller gaps are rounding
const GAPS = {type: "log", tickvals: [1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 1, 100],
              ticktext: ["rounding", "1e-8 %", "1e-6 %", "1e-4 %", "0.01 %", "1 %", "100 %", "1e4 %"]};
const FEW = {tickvals: [1e-12, 1e-8, 1e-4, 1], ticktext: ["rounding", "1e-6 %", "0.01 %", "100 %"]};  // for phones

function percent(gap) {
  return gap === null ? "no verified motion" : `${(100 * gap).toPrecision(3)} %`;
}

function variantsOf(lanes) {
  return [...new Set(lanes.map((lane) => lane.variant))].sort();
}

charts.seeds = (figure, found) => {
  const variants = variantsOf(found.lanes);
  const traces = [];
  variants.forEach((variant, k) => {
    const [tint, symbol] = VARIANTS[k % VARIANTS.length];
    const shift = (k - (variants.length - 1) / 2) * 0.7 / variants.length;
    const x = [], y = [], words = [], open = [];
    for (const lane of found.lanes.filter((one) => one.variant === variant)) {
      lane.gap.forEach((gap, i) => {
        if (gap === null) return;
        x.push(Math.max(gap, SMALLEST));
        y.push(found.swarms.indexOf(lane.swarm) + shift);
        open.push(lane.keeps[i] ? symbol : `${symbol}-open`);
        words.push(`${text(lane.swarm)}, ${text(variant)}, seed ${lane.seed[i]}<br>${percent(gap)}`
                   + (lane.keeps[i] ? "" : "<br>the claimed motion breaks its limits"));
      });
    }
    traces.push({type: "scatter", mode: "markers", name: text(variant), x, y, hovertext: words,
                 hovertemplate: "%{hovertext}<extra></extra>",
                 marker: {color: colour(tint), symbol: open, size: 7, line: {width: 1.2}}});
  });
  const lost = found.lanes.filter((lane) => lane.gap.includes(null)).map((lane) => ({
    xref: "paper", x: 1, xanchor: "right", y: found.swarms.indexOf(lane.swarm)
      + (variants.indexOf(lane.variant) - (variants.length - 1) / 2) * 0.7 / variants.length,
    text: `${lane.gap.filter((gap) => gap === null).length} of ${lane.gap.length} without a motion`,
    showarrow: false, font: {size: 10, color: colour(VARIANTS[variants.indexOf(lane.variant) % 6][0])},
  }));
  const small = narrow(figure), names = found.swarms.map((name) => fold(name, small ? 14 : 40));
  const rows = Math.max(...names.map((name) => name.split("<br>").length));
  plot(figure, traces, layout({
    height: (small ? 200 : 130) + (10 + 16 * rows) * found.swarms.length, showlegend: true, annotations: lost,
    xaxis: {...GAPS, ...(small && FEW), title: {text: fold("gap to the best motion of the family; every seed is a mark, hollow: breaks limits as claimed", small ? 34 : 120)},
            range: [-12.4, 1.5]},
    yaxis: {tickvals: found.swarms.map((_, k) => k), ticktext: names,
            range: [found.swarms.length - 0.5, -0.5]},
  }));
};

charts.progress = (figure, found) => {
  const variants = variantsOf(found.curves);
  const show = figure.dataset.show ?? "gap";
  const variant = figure.dataset.variant ?? (variants.includes("stretched") ? "stretched" : variants[0]);
  const again = (key) => (value) => {
    figure.dataset[key] = value;
    draw(figure);
  };
  controls(figure, () => [
    choice("show", [["gap", "median gap"], ["reached", "share of targets reached (ECDF)"]], show, again("show")),
    choice("coding", variants.map((one) => [one, one]), variant, again("variant")),
  ]);
  const mine = found.curves.filter((curve) => curve.variant === variant);
  const tints = ["blue", "red", "green", "orange", "purple", "sky", "ink"];
  const dashes = ["solid", "dash", "dot", "dashdot"];
  const traces = mine.map((curve, k) => ({
    type: "scatter", mode: "lines", name: text(curve.swarm), x: curve.at,
    y: show === "gap" ? curve.gap[1].map((gap) => (gap === null ? null : Math.max(gap, SMALLEST)))
      : curve.reached.map((share) => 100 * share),
    customdata: curve.at.map((_, i) => [curve.gap[0][i], curve.gap[2][i]].map(percent).join(" to ")),
    hovertemplate: show === "gap"
      ? `${text(curve.swarm)}: %{y:.3e} (quartiles %{customdata}) after %{x} evaluations<extra></extra>`
      : `${text(curve.swarm)}: %{y:.1f} % after %{x} evaluations<extra></extra>`,
    line: {color: colour(tints[k % tints.length]), dash: dashes[Math.floor(k / tints.length) % 4], width: 2},
  }));
  const low = narrow(figure);
  plot(figure, traces, layout({
    height: 460 + (low ? 16 * mine.length : 0), showlegend: true,
    legend: low ? {orientation: "h", x: 0, y: -0.2, yanchor: "top"} : {x: 1.02, y: 1},
    xaxis: {type: "log", title: {text: "evaluations, over the whole motion"}},
    yaxis: show === "gap" ? {...GAPS, title: {text: "gap of the best so far"}}
      : {title: {text: "runs and targets reached [%]"}, range: [0, 102]},
  }));
};
