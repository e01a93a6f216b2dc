#include "report/pareto_report.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "report/drawing.h"
#include "study/advice.h"

namespace railstep {
namespace {

constexpr const char* kAxes =
    "set grid lc rgb '#dddddd'\nset tics nomirror\nset border 3\nset logscale xy\n"
    "set format y '10^{%L}'\nset key outside right top Left reverse samplen 1\n";

/// The series of a setting: its model, and how it changes the scene. It may stand in single quotes.
std::string series_of(const Setting& setting) {
  std::string series = fmt::format("{} {}", setting.model, fmt::join(setting.changes, " "));
  std::replace(series.begin(), series.end(), '\'', '"');
  return series;
}
std::vector<std::string> all_series(const ParetoResult& result) {
  std::vector<std::string> all;
  for (const SettingRow& row : result.rows)
    if (const std::string own = series_of(row.setting);
        std::find(all.begin(), all.end(), own) == all.end())
      all.push_back(own);
  return all;
}

/// Error over a cost, a series of points for each model and change, and the front as a line.
std::string cost_plot(const ParetoResult& result, const std::string& name, const std::string& label,
                      double (*cost)(const SettingRow&)) {
  const double floor = floor_of(result.reference);
  std::string data, plot;
  int number = 0;
  for (const std::string& series : all_series(result)) {
    std::string points;
    for (const SettingRow& row : result.rows)
      if (series_of(row.setting) == series && row.failure.empty() &&
          std::isfinite(row.errors.judged))
        points += fmt::format("{:.9g} {:.9g}\n", cost(row), std::max(row.errors.judged, floor));
    ++number;
    if (points.empty()) continue;
    data += fmt::format("$m{} << EOD\n{}EOD\n", number, points);
    plot += fmt::format(" $m{0} with points pt {1} ps .7 lc {0} title '{2}' noenhanced,", number,
                        4 + number % 10, series);
  }
  std::vector<const SettingRow*> front;
  for (const SettingRow& row : result.rows)
    if (row.on_front) front.push_back(&row);
  std::sort(front.begin(), front.end(),
            [&](const SettingRow* a, const SettingRow* b) { return cost(*a) < cost(*b); });
  std::string line;
  for (const SettingRow* const row : front)
    line += fmt::format("{:.9g} {:.9g}\n", cost(*row), std::max(row->errors.judged, floor));
  if (plot.empty() || line.empty()) return {};
  return drawn(fmt::format(
      "set terminal svg size 900,460 name '{}' enhanced font 'sans,12'\n{}set xlabel '{}'\n"
      "set ylabel 'largest error over peak'\n{}$front << EOD\n{}EOD\n"
      "plot{} $front with steps lw 1.5 lc rgb '#000000' title 'front'\n",
      name, kAxes, label, data, line, plot));
}

std::string frequency_plot(const ParetoResult& result) {
  std::string data, plot;
  int number = 0;
  for (const ReceptanceErrors& own : result.receptances) {
    ++number;
    data += fmt::format("$r{} << EOD\n", number);
    for (std::size_t i = 0; i < own.error.size(); ++i)
      data += fmt::format("{:.9g} {:.9g}\n", result.hz[i], std::max(own.error[i], 1e-12));
    data += "EOD\n";
    plot += fmt::format("{} $r{} with lines lw 1.5 title \"{}, {} a bay\"", plot.empty() ? "" : ",",
                        number, own.model, own.elements_per_bay);
  }
  if (plot.empty()) return {};
  return drawn(
      fmt::format("set terminal svg size 900,420 name 'frequency' enhanced font 'sans,12'\n{}"
                  "set xrange [{}:{}]\nset xlabel 'frequency, Hz'\nset ylabel 'error of the "
                  "receptance'\n{}plot{}\n",
                  kAxes, result.hz.front(), result.hz.back(), data, plot));
}

std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("<td data-v='{0:.9g}'>{0:.3g}</td>", value)
                              : "<td data-v='1e300'></td>";
}

std::string table_row(const ParetoResult& result, const SettingRow& row) {
  const Setting& own = row.setting;
  std::string line = fmt::format("<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>",
                                 row.on_front ? " class=front" : "",
                                 escaped(fmt::format("{}", fmt::join(own.changes, " "))), own.model,
                                 own.elements_per_bay, row.kept_unknowns, own.scheme);
  line += cell(1e6 * own.step);
  if (!row.failure.empty())
    return line + fmt::format("<td data-v='1e300' colspan=10>{}</td></tr>\n", escaped(row.failure));
  const double floor = floor_of(result.reference), error = row.errors.judged;
  line += fmt::format("<td data-v='{:.9g}'>{}</td>", std::max(error, floor),
                      escaped(error_text(error, floor)));
  for (const double value :
       {row.parts.step, row.parts.changes, row.parts.condensation, row.parts.mesh, row.cost.us,
        row.cost.least, row.cost.most, static_cast<double>(row.cost.flops),
        static_cast<double>(row.cost.bytes)})
    line += cell(value);
  for (const KindError& kind : row.errors.kinds) line += cell(kind.largest) + cell(kind.rms);
  return line + fmt::format("<td>{}</td></tr>\n", fmt::join(row.status, " "));
}

std::string table(const ParetoResult& result) {
  std::string head;
  for (const char* name :
       {"changes", "model", "elements a bay", "kept unknowns", "scheme", "step, us", "error",
        "of the step", "of the changes", "of the condensation", "of the mesh", "frame, us", "least",
        "most", "flops", "bytes"})
    head += fmt::format("<th>{}</th>", name);
  for (const SettingRow& row : result.rows)
    if (!row.errors.kinds.empty()) {
      for (const KindError& kind : row.errors.kinds)
        head += fmt::format("<th>{0}</th><th>{0}, rms</th>", name_of(kind.kind));
      break;
    }
  std::string rows;
  for (const SettingRow& row : result.rows) rows += table_row(result, row);
  return fmt::format(
      "<table id=rows><thead><tr>{}<th>status</th></tr></thead><tbody>\n{}</tbody></table>", head,
      rows);
}

constexpr const char* kTableStyle =
    "table{border-collapse:collapse;font-size:13px}th{cursor:pointer;vertical-align:bottom}"
    "tr.front td{font-weight:bold}tbody tr:nth-child(even){background:#f4f4f4}"
    "td,th{padding:.1em .8em .1em 0}";

/// A click on a column's head sorts by it, another one the other way round.
constexpr const char* kSort =
    "document.querySelectorAll('#rows th').forEach((head,i)=>head.onclick=()=>{"
    "const body=document.querySelector('#rows tbody'),up=head.dataset.up!=='1';"
    "head.dataset.up=up?'1':'0';"
    "const key=r=>{const c=r.cells[i];if(!c)return 1e300;"
    "const v=c.dataset.v??c.textContent;return isNaN(v)||v===''?v:+v};"
    "[...body.rows].sort((a,b)=>{const x=key(a),y=key(b);"
    "const d=typeof x==='number'&&typeof y==='number'?x-y:String(x).localeCompare(String(y));"
    "return up?d:-d}).forEach(r=>body.append(r))})";

}  // namespace

std::string pareto_report(const std::string& title, const ParetoResult& result) {
  std::string words;
  for (const std::string& sentence : advice(result))
    words += fmt::format("<li>{}</li>", escaped(sentence));
  const auto by_time = [](const SettingRow& row) { return row.cost.us; };
  const auto by_flops = [](const SettingRow& row) { return static_cast<double>(row.cost.flops); };
  return fmt::format(
      "<!doctype html><html><head><meta "
      "charset=utf-8><title>{0}</title><style>{1}{2}</style></head>"
      "<body><h1>{0}</h1><p>Error: the largest difference of {3} from the reference, over the "
      "largest value, from {4:g} s on. Reference: {5}; its own error is estimated at {6:.1e}, and "
      "errors below ten times that are not told apart. Cost: of a frame of {7:g} s, median of {8} "
      "timings, each in turn with one model that stays the same, and the bounds that a model "
      "states. "
      "Parts: of the step against small steps, of changes of the scene against the scene without "
      "them, of the condensation against full order on its mesh, "
      "of the mesh against the reference.</p><h2>Which to take</h2><p>Cheapest of those whose "
      "error, and the sum of its parts, is at most that:</p><ul>{9}</ul>"
      "<h2>Error over time</h2>{10}<h2>Error over flops</h2>{11}<h2>Error over frequency</h2>"
      "<p>Of the receptance under a wheel at mid-bay and over a seat, over its largest value, "
      "against twice the elements. Models on the front.</p>{12}<h2>All settings</h2><p>Sorts by a "
      "click; bold: on the front.</p>{13}<script>{14}</script></body></html>\n",
      escaped(title), kReportStyle, kTableStyle, escaped(judged_text(result)), result.judged.from,
      escaped(result.reference.how), result.reference.error, result.frame, Timing::kRepeats, words,
      cost_plot(result, "time", "median of a frame, us", by_time),
      cost_plot(result, "flops", "flops of a frame, bound", by_flops), frequency_plot(result),
      table(result), kSort);
}

namespace {

std::string csv_text(std::string text) {
  std::replace(text.begin(), text.end(), '"', '\'');
  return text.empty() ? text : fmt::format("\"{}\"", text);
}

}  // namespace

std::string pareto_csv(const ParetoResult& result) {
  std::string text =
      "model,elements_per_bay,kept_unknowns,scheme,step_s,error,error_step,error_condensation,"
      "error_mesh,frame_us_median,frame_us_least,frame_us_most,flops_per_frame,bytes_per_frame,"
      "on_front";
  for (const OutputKind kind : kOutputKinds)
    text += fmt::format(",{0}_largest,{0}_rms", name_of(kind));
  text += ",error_changes,changes,failure\n";
  for (const SettingRow& row : result.rows) {
    text += fmt::format(
        "{},{},{},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{},{}",
        row.setting.model, row.setting.elements_per_bay, row.kept_unknowns, row.setting.scheme,
        row.setting.step, row.errors.judged, row.parts.step, row.parts.condensation, row.parts.mesh,
        row.cost.us, row.cost.least, row.cost.most, row.cost.flops, row.cost.bytes,
        row.on_front ? 1 : 0);
    for (const OutputKind kind : kOutputKinds) {
      const auto own = std::find_if(row.errors.kinds.begin(), row.errors.kinds.end(),
                                    [&](const KindError& k) { return k.kind == kind; });
      text += own == row.errors.kinds.end()
                  ? std::string(",,")
                  : fmt::format(",{:.17g},{:.17g}", own->largest, own->rms);
    }
    text += fmt::format(",{:.17g},{},{}\n", row.parts.changes,
                        csv_text(fmt::format("{}", fmt::join(row.setting.changes, " "))),
                        csv_text(row.failure));
  }
  return text;
}

}  // namespace railstep
