// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/report/html/table_page.h"

namespace limen {

const char* table_page_style() {
  return R"(
:root { --page: #f5f4f0; --paper: #fff; --ink: #1d2a35; --soft: #5a6873; --line: #dcdfe1; --good: #1f6fb4; --doubt: #a85300; --bad: #b3261e; --weak: #5f6a73; }
@media (prefers-color-scheme: dark) { :root { --page: #11171c; --paper: #192128; --ink: #e7ecf0; --soft: #9dabb6; --line: #2b3640; --good: #6fb3ec; --doubt: #f3a155; --bad: #ff8a80; --weak: #8d9aa5; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 15px/1.5 system-ui, "Segoe UI", "Noto Sans", "Liberation Sans", sans-serif; }
main { max-width: 1200px; margin: 0 auto; padding: 24px 28px 60px; }
h1 { font-size: 28px; line-height: 1.2; margin: 0 0 6px; }
h2 { font-size: 19px; margin: 34px 0 10px; }
.soft { color: var(--soft); }
.card, .plan { background: var(--paper); border: 1px solid var(--line); border-radius: 10px; }
.card { padding: 12px 18px; margin: 10px 0; border-left: 4px solid var(--doubt); }
.plan { width: 100%; height: auto; display: block; }
.scroll { overflow-x: auto; background: var(--paper); border: 1px solid var(--line); border-radius: 10px; }
table { border-collapse: collapse; width: 100%; font-size: 13.5px; }
th, td { text-align: left; padding: 6px 12px; border-bottom: 1px solid var(--line); vertical-align: top; }
th { color: var(--soft); font-weight: 600; white-space: nowrap; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td.path { overflow-wrap: anywhere; }
:focus-visible { outline: 2.5px solid var(--good); outline-offset: 2px; }
.state { font-weight: 650; white-space: nowrap; }
.registered, .verified { --c: var(--good); } .probable, .ambiguous, .bridge, .under_constrained { --c: var(--doubt); }
.rejected, .unreadable { --c: var(--bad); } .floating, .weak { --c: var(--weak); }
.state { color: var(--c); }
.wall { stroke: var(--soft); stroke-opacity: .35; stroke-width: 1.5; fill: none; }
.link { stroke: var(--c); stroke-width: 2.5; stroke-opacity: .8; }
.link.bridge { stroke-dasharray: 9 5; } .link.ambiguous { stroke-dasharray: 3 5; } .link.rejected { stroke-dasharray: 2 8; } .link.weak { stroke-width: 1.2; }
.node circle, .node path { fill: var(--paper); stroke: var(--c); stroke-width: 2.5; } .node text { font: 600 10px system-ui, sans-serif; text-anchor: middle; fill: var(--ink); }
.sigma { fill: var(--c); fill-opacity: .18; }
.answer { font: inherit; font-size: 13px; margin: 0 6px 6px 0; padding: 3px 10px; border: 1px solid var(--line); border-radius: 6px; background: var(--page); color: var(--ink); cursor: pointer; } .card p { margin: 0 0 8px; }
#paste code { display: block; margin-top: 4px; padding: 8px 10px; background: var(--paper); border: 1px solid var(--line); user-select: all; }
@media print {
  @page { size: A4; margin: 12mm; }
  body { background: #fff; font-size: 12px; } main { padding: 0; max-width: none; } .answer, #paste { display: none; }
  .scroll { overflow: visible; } tr, .card, .plan { break-inside: avoid; } h2 { break-after: avoid; }
}
.bar { stroke: var(--ink); stroke-width: 3; } .scale { font: 12px system-ui, sans-serif; fill: var(--ink); }
)";
}

}  // namespace limen
