"use strict";
// Where the time goes: one bar per coding, from the certified bound up to the motion of a swarm.

const SHARES = {bound: "green", proof: "soft", path: "blue", timing: "sky", family: "blue",
                synchronisation: "orange", optimiser: "red"};

function wholeOf(bar) {
  return Math.max(...Object.values(bar.shares).flat());
}

charts.split = (figure, found) => {
  const small = narrow(figure);
  const traces = Object.entries(SHARES).map(([share, tint]) => {
    const mine = found.bars.filter((bar) => share in bar.shares);
    const words = found.meanings[share] ? `${share}: ${found.meanings[share]}` : share;
    return {type: "scatter", mode: "lines", name: fold(words, small ? 40 : 100), connectgaps: false,
            x: mine.flatMap((bar) => [...bar.shares[share], null]), y: mine.flatMap((bar) => [text(bar.name), text(bar.name), null]),
            hovertemplate: mine.flatMap((bar) => {
              const [low, high] = bar.shares[share];
              const said = `${share}: ${(high - low).toFixed(6)} s, from ${low.toFixed(4)} to ${high.toFixed(4)} s<extra></extra>`;
              return [said, said, ""];
            }),
            line: {color: colour(tint), width: 24}};
  }).filter((trace) => trace.x.length);
  const notes = found.bars.map((bar) => {
    const whole = wholeOf(bar), bound = bar.shares.bound[1];
    return {x: whole, y: text(bar.name), xanchor: "left", xshift: 6, showarrow: false,
            text: `${whole.toFixed(3)} s,${small ? "<br>" : " "}${(100 * (whole / bound - 1)).toPrecision(3)} % above`, font: {size: 12}};
  });
  const longest = Math.max(...found.bars.map(wholeOf));
  plot(figure, traces, layout({
    height: (small ? 400 : 200) + 44 * found.bars.length, showlegend: true, annotations: notes,
    xaxis: {title: {text: "time [s]"}, range: [0, longest * (small ? 1.9 : 1.3)]},
    yaxis: {type: "category", range: [found.bars.length - 0.5, -0.5], showgrid: false},
    legend: {x: 0, y: 1.02, yanchor: "bottom"},
  }));
};
