// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace pointplane
{
/** On paper no grid: browsers move a grid that fits one page to the next one as a whole. */
inline constexpr std::string_view kReportStyle = R"css(
:root{color-scheme:light dark;--ink:#1c2430;--muted:#5b6672;--page:#f4f6f8;--card:#fff;--edge:#dde3e9}
*{box-sizing:border-box}
body{margin:0;font:15px/1.45 system-ui,"DejaVu Sans",sans-serif;color:var(--ink);background:var(--page)}
header,main,footer{max-width:1240px;margin:0 auto;padding:.75rem}
header h1{margin:.4rem 0 0;font-size:1.35rem;overflow-wrap:anywhere}
header p,footer{margin:.2rem 0 0;color:var(--muted);overflow-wrap:anywhere}
main{display:grid;gap:.75rem;grid-template-columns:repeat(6,minmax(0,1fr))}
section{background:var(--card);border:1px solid var(--edge);border-radius:8px;padding:.75rem;
min-width:0;grid-column:span 3}
section.wide{grid-column:1/-1}
section.small{grid-column:span 2}
h2{font-size:1rem;margin:0 0 .5rem;overflow-wrap:anywhere}
.scroll{overflow-x:auto}
table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:.88rem}
th,td{padding:.25rem .5rem;text-align:right;border-bottom:1px solid var(--edge);vertical-align:top}
th{font-weight:600}
td{white-space:nowrap}
td.text,th.text{white-space:normal;text-align:left}td.text{min-width:11ch}
th:first-child,td:first-child{text-align:left;position:sticky;left:0;background:var(--card);
white-space:normal;overflow-wrap:anywhere;min-width:13ch}
svg.plot{display:block;width:100%;height:auto;overflow:visible}
img{max-width:100%;height:auto;display:block;border-radius:4px}
p{margin:.2rem 0;overflow-wrap:anywhere}
p.detail{margin:0 0 .5rem;color:var(--muted);font-size:.88rem}
pre{overflow-x:auto;font-size:.8rem;white-space:pre-wrap;overflow-wrap:anywhere}
#reading{position:fixed;pointer-events:none;background:var(--ink);color:var(--card);font-size:.8rem;
padding:.1rem .4rem;border-radius:4px;display:none}
@media(max-width:900px){section,section.small{grid-column:1/-1}}
@media screen and (max-width:560px){section{overflow-x:auto}section:not(.small)>svg.plot{min-width:580px}
section,.scroll{background:linear-gradient(90deg,var(--card) 40%,#0000) 0/3rem 100% no-repeat local,
linear-gradient(270deg,var(--card) 40%,#0000) 100%/3rem 100% no-repeat local,
linear-gradient(90deg,#0003,#0000) 0/1rem 100% no-repeat scroll,
linear-gradient(270deg,#0003,#0000) 100%/1rem 100% no-repeat scroll,var(--card)}
th,td{padding:.25rem .3rem}th:first-child,td:first-child{min-width:11ch}}
@media(min-width:560px) and (max-width:900px){section.small{grid-column:span 3}}
@media screen and (prefers-color-scheme:dark){:root{--ink:#e8ecf0;--muted:#9aa5b1;--page:#14191f;
--card:#1d242c;--edge:#333d47}}
@media print{svg.plot{max-height:66mm}@page{margin:12mm}body{background:#fff;font-size:9.5pt}h2{font-size:9pt}p.detail{font-size:7.5pt}header,main,footer{padding:0 0 6pt}
main{display:flex;flex-wrap:wrap;gap:6pt}
section{break-inside:avoid;padding:5pt;flex:0 0 calc(50% - 3pt)}
section.small{flex-basis:calc(100%/3 - 4pt)}section.wide{flex-basis:100%}
.scroll{overflow:visible}table{font-size:7.5pt}th,td{padding:1.5pt 3pt}td{white-space:normal}}
)css";

/** Says what the point nearest to the pointer is. */
inline constexpr std::string_view kReportScript = R"js(
const box = document.getElementById('reading');
const value = (p, [p0, p1, v0, v1, log]) => {
  const f = (p - p0) / (p1 - p0);
  return Number((log ? v0 * Math.pow(v1 / v0, f) : v0 + f * (v1 - v0)).toPrecision(4));
};
document.querySelectorAll('svg.plot').forEach(svg => {
  let points;
  svg.addEventListener('pointerleave', () => { box.style.display = 'none'; });
  svg.addEventListener('pointermove', e => {
    points = points || [...svg.querySelectorAll('g[data-name]')].flatMap(g =>
      [...g.querySelectorAll('polyline')].flatMap(l => [...l.points].map(p => ({g, x: p.x, y: p.y})))
      .concat([...g.querySelectorAll('circle')].map(c => ({g, x: +c.getAttribute('cx'), y: +c.getAttribute('cy')}))));
    const at = new DOMPoint(e.clientX, e.clientY).matrixTransform(svg.getScreenCTM().inverse());
    const d = p => Math.hypot(p.x - at.x, p.y - at.y);
    const near = points.reduce((a, b) => d(b) < d(a) ? b : a, {x: 1e9, y: 1e9});
    box.style.display = d(near) < 30 ? 'block' : 'none';
    if (d(near) >= 30) return;
    const s = near.g.dataset.scale.split(' ').map(Number);
    box.textContent = near.g.dataset.name + ': ' + value(near.x, s.slice(0, 5)) + ', ' +
      value(near.y, s.slice(5));
    box.style.left = Math.min(e.clientX + 12, innerWidth - box.offsetWidth - 4) + 'px';
    box.style.top = (e.clientY - 28) + 'px';
  });
});
// For tests: whether the page is wider than the window, or a table wider than its card.
const root = document.documentElement;
root.dataset.overflow = root.scrollWidth > root.clientWidth;
root.dataset.clipped = [...document.querySelectorAll('.scroll')].some(s => s.scrollWidth > s.clientWidth);
)js";
}  // namespace pointplane
