/** Sliders of the design variables; a Gaussian process for each number, solved on first use. */
const whatIf = report.what_if;
const BANDS = [0.6744897501960817, 1.6448536269514722];  // half widths of 50 % and 90 %, in standard deviations

/** Squared distance of two designs, each variable in its length; names are all one apart. */
function separation(a, b, lengths) {
  let sum = 0;
  whatIf.variables.forEach((variable, k) => {
    const away = variable.named ? (a[k] === b[k] ? 0 : 1) : (a[k] - b[k]) / variable.values.length;
    sum += (away / lengths[k]) ** 2;
  });
  return sum;
}
function matern(squared) {
  const scaled = Math.sqrt(5 * squared);
  return (1 + scaled + scaled * scaled / 3) * Math.exp(-scaled);
}
/** Solves L x = b for the lower factor `L`, rows of different length. */
function forward(L, b) {
  const x = new Float64Array(b.length);
  for (let i = 0; i < b.length; i++) {
    let sum = b[i];
    for (let j = 0; j < i; j++) sum -= L[i][j] * x[j];
    x[i] = sum / L[i][i];
  }
  return x;
}

/** The process through `values` at the grid points `grids`. */
function processOf(grids, values, lengths, noise) {
  const n = values.length, center = values.reduce((s, v) => s + v, 0) / n;
  const scale = Math.sqrt(values.reduce((s, v) => s + (v - center) ** 2, 0) / n);
  const L = [];
  for (let i = 0; i < n; i++) {
    L.push(new Float64Array(i + 1));
    for (let j = 0; j <= i; j++) {
      let sum = i === j ? 1 + noise : matern(separation(grids[i], grids[j], lengths));
      for (let k = 0; k < j; k++) sum -= L[i][k] * L[j][k];
      L[i][j] = i === j ? Math.sqrt(sum) : sum / L[j][j];
    }
  }
  const half = forward(L, values.map(v => (v - center) / scale));
  const variance = half.reduce((s, v) => s + v * v, 0) / n;
  return grid => {
    const row = forward(L, grids.map(g => matern(separation(g, grid, lengths))));
    const mean = center + scale * row.reduce((s, v, i) => s + v * half[i], 0);
    const left = Math.max(1 - row.reduce((s, v) => s + v * v, 0), 1e-12);
    return {mean, deviation: scale * Math.sqrt(variance * left), noise: scale * Math.sqrt(variance * noise)};
  };
}

const scaled = (value, [median, unit]) => { const z = (value - median) / unit; return z > 0 ? Math.log1p(z) : z; };
const unscaled = (z, [median, unit]) => median + unit * (z > 0 ? Math.expm1(z) : z);
/** Cumulative normal distribution (Abramowitz and Stegun 26.2.17, error below 1e-7). */
function normal(z) {
  const t = 1 / (1 + 0.2316419 * Math.abs(z));
  const tail = Math.exp(-z * z / 2) / Math.sqrt(2 * Math.PI) * t * (0.319381530 + t * (-0.356563782 + t * (1.781477937 + t * (-1.821255978 + t * 1.330274429))));
  return z > 0 ? 1 - tail : tail;
}

/** Prediction of a number in the unit that is shown: mean, ends of the bands, chance that its limit is kept. */
function predicted(number, grid) {
  number.process ??= processOf(number.rows.map(r => whatIf.grids[r]), number.scaling ? number.values.map(v => scaled(v, number.scaling)) : number.values, number.lengths, number.noise);
  const at = number.process(grid), shown = z => number.factor * (number.scaling ? unscaled(z, number.scaling) : z);
  const whole = Math.hypot(at.deviation, at.noise);
  const [sign, limit] = number.limit ?? [];
  const away = sign ? (number.factor * at.mean - limit) / (Math.abs(number.factor) * whole) : 0;
  return {mean: shown(at.mean), bands: BANDS.map(k => [shown(at.mean - k * whole), shown(at.mean + k * whole)].sort((a, b) => a - b)), kept: sign ? normal(sign === '>=' ? away : -away) : 1};
}
function completes(grid) {
  const model = whatIf.completed;
  if (!model) return 1;
  model.process ??= processOf(whatIf.grids, model.values, model.lengths, model.noise);
  const at = model.process(grid);
  return normal((at.mean - 0.5) / Math.max(at.deviation, model.least));
}
const outside = grid => whatIf.variables.map((v, k) => k).filter(k => grid[k] < whatIf.lowest[k] || grid[k] > whatIf.highest[k]);

/** The evaluated design that is nearest in grid steps. */
function nearestDesign(grid) {
  const steps = whatIf.grids.map(g => g.reduce((s, v, k) => s + Math.abs(v - grid[k]), 0));
  const row = steps.indexOf(Math.min(...steps));
  return {index: whatIf.entries[row], steps: steps[row]};
}

const gridOf = design => design.x.map((value, k) => whatIf.variables[k].values.indexOf(value));
const chosenGrid = () => whatIf.variables.map((v, k) => Number(element(`slider-${k}`).value));
const percentage = value => `${(100 * value).toPrecision(value >= 1 ? 3 : 2)} %`;
const share = value => value > 0.99 ? '> 99 %' : value < 0.01 ? '< 1 %' : `${Math.round(100 * value)} %`;

/** Ends of a number's bar: what was evaluated, without the worst quarter of an objective, and the limit. */
function barEnds(model) {
  if (!model.ends) {
    const values = [...model.values].sort((a, b) => a - b);
    const shown = [values[0], values[Math.floor((model.scaling ? 0.75 : 1) * (values.length - 1))]].map(v => model.factor * v);
    const all = model.limit ? [...shown, model.limit[1]] : shown, ends = [Math.min(...all), Math.max(...all)];
    const margin = 0.08 * (ends[1] - ends[0] || 1);
    model.ends = [ends[0] - margin, ends[1] + margin];
  }
  return model.ends;
}

/** A predicted number: text, bar with bands, the original (line), the limit (dashed line). */
function predictedRow(model, p, evaluated, trusted) {
  const [low, high] = barEnds(model), k = model.objective;
  const place = value => Math.min(100, Math.max(0, 100 * (value - low) / (high - low)));
  const band = ([a, b], kind) => `<i class="${kind}" style="left:${place(a)}%;width:${Math.max(0.4, place(b) - place(a))}%"></i>`;
  const before = original && known(k) ? original.f[k] : null;
  const was = known(k) ? evaluated?.f[k] : evaluated?.c[report.constraints.findIndex(c => c.key === model.key)];
  const said = [];
  if (model.limit) said.push(`${model.limit[0] === '>=' ? '≥' : '≤'} ${plain(model.limit[1])}${trusted ? `, kept with ${share(p.kept)}` : ''}`);
  said.push(trusted ? `90 %: ${number(p.bands[1][0])} … ${number(p.bands[1][1])}` : 'no band outside of the sample');
  if (known(was)) said.push(`evaluated: ${number(was)}`);
  said.push(`leave-one-out ${percentage(model.quality[0])}, ${percentage(model.quality[1])} in band`);
  const marks = (known(before) ? `<u style="left:${place(before)}%" title="original"></u>` : '') + (model.limit ? `<s style="left:${place(model.limit[1])}%" title="limit"></s>` : '');
  return `<div class="predicted"><span>${escaped(model.label)}${model.poor ? ' <b class="bad">unreliable</b>' : ''}</span><b>${withUnit(number(p.mean), model.unit)}</b>` +
    `<div class="band">${trusted ? band(p.bands[1], 'wide') + band(p.bands[0], 'half') : ''}${marks}<em style="left:${place(p.mean)}%"></em></div><small>${said.join('; ')}</small></div>`;
}

/** What is said of the design as a whole: chance of a result, warnings, the nearest evaluated design. */
function whatIfNotes(grid, near) {
  const notes = [], chance = completes(grid), beyond = outside(grid);
  if (beyond.length) notes.push(`<p class="notice bad">${beyond.map(k => escaped(report.variables[k].label.toLowerCase())).join(' and ')} outside of all designs with a result: only means are shown, and they may be far off.</p>`);
  if (chance < 0.95) notes.push(`<p class="notice${chance < 0.5 ? ' bad' : ''}">Chance that it gives a result at all (flight not lost, evaluation not failed): ${share(chance)}.</p>`);
  const where = near.steps === 0 ? 'This design was evaluated' : `Nearest evaluated design, ${near.steps} grid ${near.steps === 1 ? 'step' : 'steps'} away`;
  notes.push(`<p class="count">${where}: <button type="button" class="link" data-select="${near.index}">${name(designs[near.index])}</button></p>`);
  return notes.join('');
}

function drawWhatIf() {
  if (!whatIf || !element('what-if-numbers')) return;
  const grid = chosenGrid(), near = nearestDesign(grid), trusted = !outside(grid).length;
  const predictions = whatIf.numbers.map(model => predicted(model, grid));
  whatIf.variables.forEach((v, k) => {
    const value = v.values[grid[k]], unit = report.variables[k].unit;
    element(`slider-${k}-value`).innerHTML = withUnit(plain(value), unit);
    element(`slider-${k}`).setAttribute('aria-valuetext', `${value} ${unit}`);
  });
  const evaluated = near.steps === 0 ? designs[near.index] : null;
  element('what-if-numbers').innerHTML = whatIf.numbers.map((model, i) => predictedRow(model, predictions[i], evaluated, trusted)).join('');
  element('what-if-notes').innerHTML = whatIfNotes(grid, near);
  drawWhatIfChart(predictions, trusted);
}

/** The prediction with its 90 % bands beside the best compromises. */
function drawWhatIfChart(predictions, trusted) {
  const plot = element('what-if-chart');
  if (!plot) return;
  const of = k => predictions[whatIf.numbers.findIndex(model => model.objective === k)];
  const [x, y] = [of(front.x), of(front.y)];
  if (!x || !y) return;
  const bar = p => ({type: 'data', symmetric: false, array: [p.bands[1][1] - p.mean], arrayminus: [p.mean - p.bands[1][0]], color: color('accent'), thickness: 1.5, width: 4, visible: trusted});
  const best = points(d => d.front && d.status === FEASIBLE);
  const traces = [
    markers(best, {size: 7, color: color('dot')}, 'best compromise'),
    markers(points(d => d === original), {symbol: 'diamond', size: 11, color: color('original')}, 'original'),
    {type: 'scatter', mode: 'markers', name: 'prediction', x: [x.mean], y: [y.mean], error_x: bar(x), error_y: bar(y), marker: {size: 11, color: color('accent')}, hovertemplate: 'prediction<extra></extra>'},
  ];
  plotly().react(plot, traces, layout({xaxis: axis(report.objectives[front.x].title), yaxis: axis(report.objectives[front.y].title), hovermode: 'closest', margin: {l: 66, r: 10, t: 10, b: 48}}), settings);
}

/** Puts the sliders on an evaluated design. */
function setSliders(i) {
  if (!whatIf || !known(i)) return;
  gridOf(designs[i]).forEach((index, k) => { if (index >= 0) element(`slider-${k}`).value = index; });
  drawWhatIf();
}

function whatIfControls() {
  if (!whatIf || !element('what-if-sliders')) return;
  element('what-if-sliders').innerHTML = whatIf.variables.map((v, k) =>
    `<label for="slider-${k}">${escaped(report.variables[k].label)} <b id="slider-${k}-value"></b></label>` +
    `<input type="range" id="slider-${k}" min="0" max="${v.values.length - 1}" step="1">`).join('');
  let asked = false;
  element('what-if-sliders').addEventListener('input', () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => { asked = false; drawWhatIf(); });
  });
  element('what-if-selected').addEventListener('click', () => setSliders(state.selected));
  whenVisible(element('what-if-chart') ?? element('what-if-numbers'), () => setSliders(state.selected));
}
