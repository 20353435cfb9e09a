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
main { max-width: 1500px; margin: 0 auto; padding: 24px 28px 60px; }
h1 { font-size: 28px; line-height: 1.2; margin: 0 0 6px; }
h2 { font-size: 19px; margin: 34px 0 10px; }
.soft { color: var(--soft); }
.plan { background: var(--paper); border: 1px solid var(--line); border-radius: 10px; width: 100%; height: auto; display: block; }
.scroll { overflow-x: auto; background: var(--paper); border: 1px solid var(--line); border-radius: 10px; }
table { border-collapse: collapse; width: 100%; font-size: 13.5px; }
th, td { text-align: left; padding: 6px 9px; border-bottom: 1px solid var(--line); vertical-align: top; }
th { color: var(--soft); font-weight: 600; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td.path { overflow-wrap: anywhere; }
:focus-visible { outline: 2.5px solid var(--good); outline-offset: 2px; }
.state { font-weight: 650; white-space: nowrap; color: var(--c); }
.logo { float: right; max-width: 240px; max-height: 72px; margin: 0 0 8px 24px; }
.cover-title { font-size: 18px; margin: 0 0 4px; }
.cover { display: flex; flex-wrap: wrap; gap: 2px 28px; margin: 0 0 18px; font-size: 14px; } .cover div { display: flex; gap: 8px; } .cover dd { margin: 0; }
dt { color: var(--soft); }
.signature { display: flex; flex-wrap: wrap; gap: 18px 48px; margin: 48px 0 24px; font-size: 14px; }
.signature div { flex: 1 1 180px; border-top: 1px solid var(--ink); padding-top: 4px; } .signature dd { margin: 0; min-height: 1.4em; }
@media print {
  @page { size: A4 landscape; margin: 12mm; }
  body { background: #fff; font-size: 12px; } main { padding: 0; max-width: none; }
  .scroll { overflow: visible; border: 0; } table { font-size: 10px; } th, td { padding: 3px 4px; overflow-wrap: anywhere; } tr, .plan, .signature { break-inside: avoid; } h2 { break-after: avoid; }
}
.bar { stroke: var(--ink); stroke-width: 3; } .scale { font: 12px system-ui, sans-serif; fill: var(--ink); }
)";
}

}  // namespace limen
