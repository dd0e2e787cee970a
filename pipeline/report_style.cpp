#include "pipeline/report_style.h"

#include "pipeline/painter.h"

namespace heddle::pipeline {

std::string report_style() {
  // System fonts only: the page needs no network, and reads like the reader's other documents.
  static constexpr std::string_view page = R"(
:root{color-scheme:light dark;--sheet:#fff;--ink:#1f2328;--faint:#5c636b;--rule:#e3e5e8;--soft:#f6f7f8;
--holds:#0b7a4b;--note:#5c636b;--attention:#a35200;--fails:#b3261e}
@media screen and (prefers-color-scheme:dark){:root{--sheet:#15181c;--ink:#e6e8eb;--faint:#a0a7af;--rule:#2a2f35;
--soft:#1c2025;--holds:#4cc38a;--note:#a0a7af;--attention:#f0a55a;--fails:#ff8a80}}
*{box-sizing:border-box}
body{margin:0;background:var(--sheet);color:var(--ink);
font:16px/1.6 system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,sans-serif;
font-variant-numeric:tabular-nums;text-rendering:optimizeLegibility}
main{max-width:1100px;margin:0 auto;padding:64px 40px 96px}
header{margin-bottom:44px}
.kind{margin:0 0 6px;color:var(--faint);font-size:13px;letter-spacing:.08em;text-transform:uppercase}
h1{margin:0 0 12px;font-size:38px;line-height:1.15;font-weight:650;letter-spacing:-.015em;overflow-wrap:anywhere}
h2{margin:72px 0 20px;font-size:23px;line-height:1.25;font-weight:650;letter-spacing:-.01em}
h3{margin:36px 0 10px;font-size:16px;font-weight:650}
p{margin:0 0 14px;max-width:68ch}
.lead{font-size:18px;color:var(--faint)}
.results{display:grid;grid-template-columns:repeat(auto-fit,minmax(170px,1fr));gap:24px;margin:0 0 44px;
padding:26px 0;border-top:1px solid var(--rule);border-bottom:1px solid var(--rule)}
.results div{display:flex;flex-direction:column-reverse;justify-content:flex-end}
.results dt{color:var(--faint);font-size:14px}
.results dd{margin:0;font-size:30px;line-height:1.25;font-weight:600;letter-spacing:-.01em;white-space:nowrap}
.results small{font-size:16px;font-weight:400;color:var(--faint);letter-spacing:0}
.verdicts{list-style:none;margin:0;padding:0}
.verdicts li{display:grid;grid-template-columns:104px 1fr;gap:8px;padding:7px 0;border-bottom:1px solid var(--rule)}
.verdicts li:last-child{border-bottom:0}
.verdicts .tone{font-size:13px;line-height:26px;font-weight:600}
.holds .tone{color:var(--holds)}.note .tone{color:var(--note);font-weight:400}
.attention .tone{color:var(--attention)}.fails .tone{color:var(--fails)}
figure{margin:0 0 36px}
figure{overflow-x:auto}
figure svg{display:block;width:100%;min-width:460px;height:auto}
figcaption{margin-top:10px;max-width:76ch;color:var(--faint);font-size:14px;line-height:1.5}
.pair{display:grid;grid-template-columns:1fr 1fr;gap:28px}
table{width:100%;border-collapse:collapse;font-size:14px;line-height:1.45;margin:0 0 12px}
.scroll{overflow-x:auto;margin-bottom:36px}
th,td{padding:7px 14px 7px 0;text-align:left;border-bottom:1px solid var(--rule);vertical-align:top}
th{font-weight:600;color:var(--faint);white-space:nowrap}
td.number,th.number{text-align:right;white-space:nowrap}
.facts{max-width:620px}
.facts td:last-child{text-align:right}
th:last-child,td:last-child{padding-right:0}
.columns{display:grid;align-items:start;grid-template-columns:1fr 1fr;gap:0 44px}
ul.notes{margin:0;padding-left:20px;max-width:72ch}
ul.notes li{margin-bottom:8px}
footer{margin-top:72px;padding-top:18px;border-top:1px solid var(--rule);color:var(--faint);font-size:13px}
@media screen and (max-width:760px){main{padding:32px 18px 56px}.pair,.columns{grid-template-columns:1fr}h1{font-size:30px}
.verdicts li{grid-template-columns:1fr;gap:0}h2{margin-top:52px}}
@media print{@page{size:A4;margin:16mm}main{max-width:none;padding:0}body{font-size:9.5pt}h1{font-size:22pt}
h2{margin-top:24pt;font-size:15pt;break-after:avoid}table,figcaption,.results dt,.verdicts .tone{font-size:8.5pt}
.verdicts li{grid-template-columns:70pt 1fr;padding:2.5pt 0}.lead{font-size:11pt}header{margin-bottom:18pt}
.results{grid-template-columns:repeat(4,1fr);margin-bottom:18pt;padding:10pt 0;gap:12pt}
figure{margin-bottom:14pt;overflow:visible}figure svg{min-width:0}
th,td{padding:3pt 8pt 3pt 0}.pair{gap:14pt}figure,tr,.verdicts li{break-inside:avoid}.results dd{font-size:18pt}
.picture path{print-color-adjust:exact;-webkit-print-color-adjust:exact}}
)";
  return std::string(page) + picture_style();
}

}  // namespace heddle::pipeline
