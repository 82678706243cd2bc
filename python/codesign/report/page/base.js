'use strict';
const report = JSON.parse(document.getElementById('data').textContent);
const designs = report.designs;
const places = new Map(designs.map((design, i) => [design, i]));
const original = report.baseline === null ? null : designs[report.baseline];
const FEASIBLE = 0, INFEASIBLE = 1, FAILED = 2, SKIPPED = 3;
const STATUS = ['feasible', 'infeasible', 'failed', 'not computed'];
const element = id => document.getElementById(id);
const escaped = text => String(text).replace(/[&<>"]/g, c => ({'&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;'})[c]);
const color = name => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
const known = value => value !== null && value !== undefined;

/** A number with about `digits` significant digits and a true minus sign, never in exponent form for usual sizes. */
function number(value, digits = 4) {
  if (!known(value)) return '–';
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e7 || size < 1e-5)) return value.toExponential(digits - 1).replace(/-/g, '−');
  const decimals = size === 0 ? 0 : Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return value.toFixed(Math.min(decimals, 8)).replace('-', '−');
}
const plain = value => typeof value === 'string' ? escaped(value) : String(value).replace('-', '−');
const percent = (value, digits = 1) => !known(value) ? '' :
  (value > 0 ? '+' : value < 0 ? '−' : '±') + Math.abs(100 * value).toFixed(digits) + ' %';
const withUnit = (text, unit) => unit ? `${text} <small>${escaped(unit)}</small>` : text;
const name = design => design === original && design.id === null ? 'Original' : `Design ${design.id}`;

/** What a design is, in words, for its tags. */
function roles(design) {
  const index = places.get(design), found = [];
  if (index === report.recommended) found.push('recommended');
  if (design === original) found.push('original');
  report.objectives.forEach(o => { if (report.best[o.key] === index) found.push((o.sign < 0 ? 'highest ' : 'lowest ') + o.label.toLowerCase()); });
  if (design.front && !found.includes('recommended')) found.push('best compromise');
  return found;
}

/** Why a design lacks a number, for the dash that stands in its place. */
const lacking = design => `<span title="${escaped(design.reason || 'not computed for this design')}">–</span>`;
const below = (c, value) => known(c.floor) && known(value) && value < c.floor;

/** Relative change of objective `k` from the original; null where either is unknown. */
function change(design, k) {
  if (!original || design === original || !known(design.f[k]) || !original.f[k]) return null;
  return (design.f[k] - original.f[k]) / Math.abs(original.f[k]);
}

const font = () => ({family: getComputedStyle(document.body).fontFamily, size: 12.5, color: color('muted')});
const axis = (title, more = {}) => ({
  title: {text: title, font: {...font(), size: 13}, standoff: 10}, gridcolor: color('line'), zeroline: false, linecolor: color('strong'),
  ticks: 'outside', ticklen: 4, tickcolor: color('strong'), tickfont: font(), ...more,
});
const layout = (more = {}) => ({
  paper_bgcolor: 'rgba(0,0,0,0)', plot_bgcolor: 'rgba(0,0,0,0)', font: font(), margin: {l: 66, r: 16, t: 10, b: 52}, showlegend: false,
  hoverlabel: {bgcolor: color('bg'), bordercolor: color('strong'), font: {...font(), color: color('ink')}, align: 'left'}, ...more,
});
/** Plotly, which takes a second or two to start: on first use, so that the page can be read before its charts stand. */
function plotly() {
  if (!window.Plotly) {
    const script = document.createElement('script');
    script.textContent = element('plotly').textContent;
    document.head.append(script);
  }
  return window.Plotly;
}

/** Draws a chart when its place comes near the screen (once what is there has been painted), or when the page is printed. */
const waiting = new Map();
const painted = act => requestAnimationFrame(() => setTimeout(act));
const watcher = new IntersectionObserver(entries => entries.filter(e => e.isIntersecting).forEach(e => painted(() => drawNow(e.target))), {rootMargin: '300px'});
function whenVisible(node, draw) {
  if (!node) return;
  waiting.set(node, draw);
  watcher.observe(node);
}
function drawNow(node) {
  const draw = waiting.get(node);
  watcher.unobserve(node);
  waiting.delete(node);
  if (draw && node.isConnected) draw(node);
}

const settings = {displaylogo: false, responsive: true, displayModeBar: false, scrollZoom: false, doubleClick: 'reset'};
