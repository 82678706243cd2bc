/** Joins the parts of the page: one selected design, one hovered design, light or dark. */
const state = {selected: report.recommended ?? (designs.length ? 0 : null), hovered: null};

function select(i, {reveal = true} = {}) {
  if (!known(i) || !designs[i]) return;
  state.selected = i;
  card(i);
  ring(5, i);
  if (!FILTERS[table.filter](designs[i])) { table.filter = designs[i].status === FEASIBLE ? 'feasible' : 'all'; drawTable(); }
  markRow();
  if (reveal) revealRow();
  drawParts(i);
  drawFlight(i);
  element('announcement').textContent = `${name(designs[i])} selected`;
}

function hover(i, from) {
  if (state.hovered === i) return;
  if (known(state.hovered)) rowOf(state.hovered)?.classList.remove('hover');
  state.hovered = i;
  if (known(i)) rowOf(i)?.classList.add('hover');
  if (from === 'table') ring(6, i);
}

function step(by) {
  const order = designs.map((d, i) => i).filter(i => designs[i].front).sort((a, b) => designs[a].f[front.x] - designs[b].f[front.x]);
  if (!order.length) return;
  const at = order.indexOf(state.selected);
  select(order[at < 0 ? 0 : (at + by + order.length) % order.length]);
}

async function copy(button) {
  const text = button.dataset.copy, label = button.textContent;
  try { await navigator.clipboard.writeText(text); button.textContent = 'Copied'; }
  catch { window.prompt('Copy this command:', text); }
  setTimeout(() => { button.textContent = label; }, 1600);
}

/** Saves the table as CSV, or a chart as a picture. */
function save(what) {
  if (what !== 'table') { plotly().downloadImage(what, {format: 'png', scale: 3, filename: `codesign-${what}`}); return; }
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob(['\ufeff' + csv()], {type: 'text/csv'}));
  link.download = 'designs.csv';
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** Draws everything at the width of the paper, in light colors; and back. */
function forPaper(starts) {
  document.documentElement.classList.toggle('printing', starts);
  paint(starts ? 'light' : remembered() || (system.matches ? 'dark' : 'light'));
  drawTable();
  if (starts) { drawFront(); [...waiting.keys()].forEach(drawNow); }
  document.querySelectorAll('.js-plotly-plot').forEach(node => plotly().relayout(node, starts ? {width: node.clientWidth, height: node.clientHeight} : {width: null, height: null, autosize: true}));
}

function remember(theme) { try { localStorage.setItem('codesign-theme', theme); } catch { /* storage is off: the choice lasts for this visit */ } }
function remembered() { try { return localStorage.getItem('codesign-theme'); } catch { return null; } }

function paint(theme) {
  document.documentElement.dataset.theme = theme;
  painted(drawFront);
  whenVisible(element('progress'), drawProgress);
  if (element('what-if-numbers')?.innerHTML) painted(drawWhatIf);
  whenVisible(element('validation-chart'), drawValidation);
  if (known(state.selected)) { drawParts(state.selected); drawFlight(state.selected); }
}

document.addEventListener('click', event => {
  const by = event.target.closest('[data-step]'), chosen = event.target.closest('[data-select]'), copied = event.target.closest('[data-copy]');
  if (by) { step(Number(by.dataset.step)); element('card').querySelector(`[data-step="${by.dataset.step}"]`).focus(); }
  if (chosen) select(Number(chosen.dataset.select));
  if (copied) copy(copied);
  const saved = event.target.closest('[data-save]');
  if (saved) save(saved.dataset.save);
});
const system = window.matchMedia('(prefers-color-scheme: dark)');
element('theme').addEventListener('click', () => {
  const theme = document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark';
  remember(theme);
  paint(theme);
});
system.addEventListener('change', () => { if (!remembered()) paint(system.matches ? 'dark' : 'light'); });
window.addEventListener('beforeprint', () => forPaper(true));
window.addEventListener('afterprint', () => forPaper(false));
window.addEventListener('resize', hintSideways);

if (!FILTERS.front || !designs.some(FILTERS.front)) table.filter = 'all';
frontControls();
tableControls();
whatIfControls();
weightControls();
drawTable();
paint(remembered() || (system.matches ? 'dark' : 'light'));
if (known(state.selected)) { card(state.selected); markRow(); }
