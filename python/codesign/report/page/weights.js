/** Weights of the objectives: the choice that an achievement scalarization prefers (Wierzbicki 1980). */
const SLIGHTLY = 1e-4;  // share of the sum, which decides between designs whose largest loss is the same

/** Best and worst value of each objective among the choices. */
const spans = report.objectives.map((o, k) => {
  const values = report.choices.map(i => designs[i].f[k]), ends = [Math.min(...values), Math.max(...values)];
  return o.sign < 0 ? ends.reverse() : ends;
});

/** Objective `k` of a choice from 0, the best among the choices, to 1, the worst. */
const loss = (i, k) => spans[k][1] !== spans[k][0] ? (designs[i].f[k] - spans[k][0]) / (spans[k][1] - spans[k][0]) : 0;

/** The choice whose largest weighted loss is least. weights: one for each objective, not all 0. */
function preferred(weights) {
  const score = i => {
    const losses = weights.map((w, k) => w * loss(i, k));
    return Math.max(...losses) + SLIGHTLY * losses.reduce((sum, value) => sum + value, 0);
  };
  return report.choices.reduce((best, i) => score(i) < score(best) ? i : best);
}

function drawPreferred() {
  const weights = report.objectives.map((o, k) => Number(element(`weight-${k}`).value));
  const sum = weights.reduce((s, w) => s + w, 0);
  weights.forEach((w, k) => { element(`weight-${k}-value`).textContent = sum ? `${Math.round(100 * w / sum)} %` : '–'; });
  if (!sum) { element('weights-choice').textContent = 'Give one of them a weight.'; return; }
  const i = preferred(weights), gives = report.objectives.map((o, k) => `${escaped(o.label.toLowerCase())} ${number(designs[i].f[k])} ${escaped(o.unit)}`);
  element('weights-choice').innerHTML = `<button type="button" class="link" data-select="${i}">${name(designs[i])}</button>${i === report.recommended ? ', the recommended one' : ''}: ${gives.join(', ')}`;
  ring(6, i);
}

function weightControls() {
  if (!element('weights')) return;
  element('weights').innerHTML = report.objectives.map((o, k) =>
    `<label for="weight-${k}">${escaped(o.label)} <b id="weight-${k}-value"></b></label><input type="range" id="weight-${k}" min="0" max="20" value="10">`).join('');
  element('weights').addEventListener('input', drawPreferred);
  drawPreferred();
}
