#pragma once

#include <string_view>

namespace likeness::page {

// The look of the report and of the overview: one column of at most 1180 px, dark on light, nothing wider than the
// window but what scrolls in its own box, and a print form without it.
inline constexpr std::string_view kPageStyle = R"css(
:root{--ink:#1c1f23;--quiet:#555c66;--line:#d5d9df;--soft:#f4f5f7;--mark:#0b5394}
*{box-sizing:border-box}
body{margin:0 auto;padding:16px;max-width:1180px;color:var(--ink);background:#fff;font:16px/1.5 system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;overflow-wrap:anywhere}
h1{font-size:1.9rem;line-height:1.2;margin:.4em 0 .3em}
h2{font-size:1.35rem;margin:2.2em 0 .4em;padding-top:.5em;border-top:2px solid var(--ink)}
h3{font-size:1.05rem;margin:1.4em 0 .4em}
.row h3{margin:0}
p{max-width:46rem;margin:.5em 0}
a{color:var(--mark)}
code{font-family:ui-monospace,"DejaVu Sans Mono",monospace;font-size:.88em}
pre{background:var(--soft);padding:10px;overflow-x:auto;white-space:pre-wrap}
.note{border-left:4px solid #b35806;background:#fff4e6;padding:.5rem .8rem;max-width:46rem}
.verdict{font-size:1.25rem;line-height:1.4}
.quiet,small,figcaption{color:var(--quiet);font-size:.875rem}
nav a{display:inline-block;margin-right:1.1em;padding:.3em 0}
figure{margin:0;min-width:0}
figcaption{line-height:1.35;margin:2px 0 0}
svg{display:block;width:100%;height:auto}
svg text{fill:var(--ink);font-family:inherit}
.pixels{image-rendering:pixelated}
.row{border-top:1px solid var(--line);padding:12px 0 14px}
.row>header{padding-top:2px;display:flex;flex-wrap:wrap;gap:0 1.2em;align-items:baseline;margin-bottom:6px}
.row.fit{background:#eef4fb;box-shadow:-8px 0 #eef4fb,8px 0 #eef4fb,-12px 0 var(--mark)}
.pictures{display:grid;grid-template-columns:218px 218px minmax(0,1fr);gap:16px;align-items:start}
.spheres img{display:block;width:100%;max-width:600px;height:auto}
.angles{display:grid;grid-template-columns:1fr 1fr 1fr;max-width:600px;text-align:center}
.intro{display:grid;grid-template-columns:minmax(0,1fr) 300px;gap:8px 32px;align-items:center}
.scroll{overflow-x:auto;border:1px solid var(--line)}
table{border-collapse:collapse;font-size:.92rem;width:100%}
th,td{padding:6px 10px;text-align:left;vertical-align:top;border-top:1px solid var(--line);overflow-wrap:normal}
thead th{border-top:0;background:var(--soft);vertical-align:bottom}
.metrics thead th{min-width:7.5rem}
tbody th{font-weight:600;min-width:11rem}
tbody th small{display:block;font-weight:400}
td.n{white-space:pre;font-variant-numeric:tabular-nums}
td.best{font-weight:700;background:#e3f1e3}
tr.fixed td,tr.fixed th{color:var(--quiet)}
.badge{display:inline-block;font-size:.8rem;border:1px solid currentColor;border-radius:3px;padding:0 5px;white-space:nowrap}
.warn{color:#8a3b00}
.swatch{display:inline-block;width:2.2em;height:1.1em;border:1px solid #777;vertical-align:-.15em;margin-right:.4em;-webkit-print-color-adjust:exact;print-color-adjust:exact}
.plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,330px),1fr));gap:24px}
.bar{display:block;height:.8em;background:var(--mark);min-width:1px;-webkit-print-color-adjust:exact;print-color-adjust:exact}
td.wide{width:60%;min-width:8rem;vertical-align:middle}
dl{display:grid;grid-template-columns:max-content minmax(0,1fr);gap:4px 18px;max-width:60rem}
dt{font-weight:600}
dd{margin:0}
details{margin:.6em 0}
summary{cursor:pointer;padding:.3em 0}
.cards{display:grid;grid-template-columns:repeat(auto-fill,minmax(150px,1fr));gap:16px;padding:0;list-style:none}
.cards a{display:block;text-decoration:none;color:inherit;border:1px solid var(--line);padding:8px}
.cards a:hover,.cards a:focus{border-color:var(--mark)}
.cards img{display:block;width:100%;height:auto}
.cards b{display:block;color:var(--mark);text-decoration:underline;margin-top:4px;line-height:1.25}
select{font:inherit;padding:4px}
@media (max-width:760px){
 .pictures{grid-template-columns:1fr 1fr;gap:10px}
 .pictures .spheres{grid-column:1/-1}
 .intro{grid-template-columns:minmax(0,1fr)}
 .cards{grid-template-columns:repeat(auto-fill,minmax(min(100%,140px),1fr));gap:10px}
 dl{grid-template-columns:minmax(0,1fr)}
 dd{margin-bottom:6px}
 tbody th{min-width:9rem}
}
@media print{
 nav,.controls{display:none}
 .row,figure,tr{break-inside:avoid}
 .scroll{overflow:visible;border:0}
 body{max-width:none;font-size:11px}
}
)css";

}  // namespace likeness::page
