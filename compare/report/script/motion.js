"use strict";
// Position to jerk of one joint, motion beside motion, from their exact polynomial pieces.

const MOTIONS = {published: ["red", "dash"], family: ["green", "solid"], fastest: ["blue", "dot"], given: ["orange", "solid"]};
const SAMPLES = 500;  // over a motion

// value of a derivative of ascending coefficients at a local time
function derivative(coefficients, order, t) {
  let value = 0;
  for (let k = coefficients.length - 1; k >= order; k--) {
    let factor = coefficients[k];
    for (let i = 0; i < order; i++) factor *= k - i;
    value = value * t + factor;
  }
  return value;
}

// times and values of a curve; a motion of too many pieces comes as the extremes of short intervals
function sampled(motion, joint, order) {
  if (motion.curves) return motion.curves[joint][order];
  const total = motion.durations.reduce((sum, one) => sum + one, 0);
  const t = [], x = [];
  let start = 0;
  motion.durations.forEach((duration, k) => {
    const count = Math.max(2, Math.ceil(SAMPLES * duration / total));
    for (let i = 0; i <= count; i++) {
      const local = duration * i / count;
      t.push(start + local);
      x.push(derivative(motion.pieces[k][joint], order, local));
    }
    start += duration;
  });
  return [t, x];
}

// without a limit one motion can be so steep that the others would be flat: it is cut off, a double click shows it whole
function cropped(extents, low, high) {
  const next = extents.toSorted((a, b) => b - a)[1];
  return low === null && high === null && Math.max(...extents) > 20 * next && next > 0 ? {range: [-1.5 * next, 1.5 * next]} : {};
}

charts.motion = (figure, found) => {
  const moving = found.joints.map((_, j) => j).filter((j) => found.joints[j].moves);
  const joint = Number(figure.dataset.joint ?? found.first ?? moving[0] ?? 0);
  const again = (value) => {
    figure.dataset.joint = value;
    draw(figure);
  };
  controls(figure, () => [
    choice("joint", found.joints.map((one, j) => [String(j), one.name]), String(joint), again),
  ]);
  const {name, units, limits, waypoints} = found.joints[joint];
  const traces = [], shapes = [], axes = {};
  found.quantities.forEach((quantity, order) => {
    const axis = order ? `y${order + 1}` : "y";
    const [low, high] = limits[order];
    const extents = [];
    for (const motion of found.motions) {
      const [tint, dash] = MOTIONS[motion.kind];
      const [t, x] = sampled(motion, joint, order);
      const title = fold(motion.title, narrow(figure) ? 40 : 90);
      extents.push(Math.max(...x.map(Math.abs)));
      traces.push({type: "scatter", mode: "lines", x: t, y: x, yaxis: axis, name: title, legendgroup: motion.kind,
                   showlegend: order === 0, line: {color: colour(tint), dash, width: 2},
                   hovertemplate: `${quantity} %{y:.4g} ${units[order]} at %{x:.4f} s<extra></extra>`});
      const slack = motion.slack * Math.max(Math.abs(low ?? 0), Math.abs(high ?? 0));
      const over = x.map((value) => ((high !== null && value > high + slack) || (low !== null && value < low - slack) ? value : null));
      if (over.some((value) => value !== null)) {
        traces.push({type: "scatter", mode: "lines", x: t, y: over, yaxis: axis, legendgroup: motion.kind,
                     showlegend: false, hoverinfo: "skip", line: {color: colour("red"), width: 6}, opacity: 0.55});
      }
      if (order === 0) {
        traces.push({type: "scatter", mode: "markers", x: motion.passages, y: waypoints, yaxis: axis, legendgroup: motion.kind,
                     showlegend: false, text: waypoints.map((_, k) => String(k + 1)),
                     hovertemplate: "waypoint %{text} at %{x:.4f} s<extra></extra>", marker: {color: colour(tint), size: waypoints.length > 40 ? 3 : 7}});
      }
    }
    const extent = Math.max(...extents);
    for (const limit of [low, high]) {
      // a position limit far away would flatten the curve
      if (limit === null || (order === 0 && Math.abs(limit) > 2 * extent)) continue;
      shapes.push({type: "line", xref: "paper", x0: 0, x1: 1, yref: axis, y0: limit, y1: limit,
                   line: {color: colour("ink"), dash: "longdash", width: 1}});
    }
    const height = 1 / found.quantities.length, top = 1 - order * height;
    axes[order ? `yaxis${order + 1}` : "yaxis"] = {
      domain: [top - 0.86 * height, top], anchor: "x",
      title: {text: `${quantity}<br>[${units[order]}]`, font: {size: 12}}, nticks: 5,
      ...cropped(extents, low, high),
    };
  });
  plot(figure, traces, layout({
    height: 640, showlegend: true, shapes, hovermode: "x", ...axes,
    margin: {l: 70, r: 10, t: 10, b: 40},
    legend: {x: 0, y: 1.02, yanchor: "bottom"},
    xaxis: {title: {text: fold(`time [s]; ${name}; dashed: limits; thick: over a limit`, narrow(figure) ? 34 : 120)}, anchor: `y${found.quantities.length}`},
  }));
};
