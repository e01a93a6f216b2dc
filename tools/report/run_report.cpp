#include "report/run_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "report/drawing.h"

namespace railstep {
namespace {

/// A plot over time of the trace's columns that end in one quantity.
struct Plot {
  const char* quantity;  // ".force_z_mean_n", say
  const char* label;     // of the axis
  double scale;
};
constexpr Plot kPlots[] = {
    {".deflection_z_m", "deflection under the load, mm", 1e3},
    {".rail_z_m", "rail under the wheel, mm", 1e3},
    {".force_z_mean_n", "wheel-rail force, mean of a frame, kN", 1e-3},
    {".flange_force_peak_n", "flange force along its normal, peak of a frame, kN", 1e-3},
    {".dz_m", "vertical displacement at the sensors, mm", 1e3}};

/// One curve a column; at most kPoints of them drawn, evenly thinned. Empty if nothing has it.
std::string curves_script(const Plot& plot, const std::vector<std::string>& columns,
                          const RunRecord& record) {
  constexpr std::size_t kPoints = 4000;
  const std::string quantity = plot.quantity;
  const std::size_t rows = record.rows.size() / columns.size(), every = rows / kPoints + 1;
  std::string curves;
  std::vector<std::size_t> chosen;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::size_t at = columns[c].rfind(quantity);
    if (at == std::string::npos || at + quantity.size() != columns[c].size()) continue;
    chosen.push_back(c);
    curves += fmt::format("{} $rows using 1:({}*${}) with lines lw 1.5 title \"{}\"",
                          curves.empty() ? "" : ",", plot.scale, 1 + chosen.size(),
                          columns[c].substr(0, at));
  }
  if (chosen.empty()) return {};
  std::string data;
  for (std::size_t r = 0; r < rows; r += every) {
    data += fmt::format("{:.9g}", record.rows[r * columns.size()]);
    for (const std::size_t c : chosen)
      data += fmt::format(" {:.9g}", record.rows[r * columns.size() + c]);
    data += '\n';
  }
  return fmt::format(
      "set terminal svg size 900,420 name '{}' noenhanced font 'sans,12'\n"
      "set xlabel 'time, s'\nset ylabel '{}'\nset grid\nset key outside top right horizontal\n"
      "$rows << EOD\n{}EOD\nplot{}\n",
      quantity.substr(1), plot.label, data, curves);
}

std::string all_curves(const std::vector<std::string>& columns, const RunRecord& record) {
  std::string html;
  for (const Plot& plot : kPlots) {
    const std::string script = curves_script(plot, columns, record);
    if (!script.empty()) html += fmt::format("<h2>{}</h2>\n{}\n", plot.label, drawn(script));
  }
  return html;
}

/// Paths of a system's sensors in the plane of x and z, both axes alike. Empty without one.
std::string paths_script(const Simulation& run, const RunRecord& record) {
  constexpr std::size_t kPoints = 4000;
  const std::vector<std::string>& columns = run.columns();
  const std::size_t rows = record.rows.size() / columns.size(), every = rows / kPoints + 1;
  std::string blocks, curves;
  for (std::size_t c = 0; run.model().system.unknowns > 0 && c < columns.size(); ++c) {
    if (!columns[c].ends_with(".x_m")) continue;
    blocks += fmt::format("$path{} << EOD\n", c);
    for (std::size_t r = 0; r < rows; r += every)
      blocks += fmt::format("{:.9g} {:.9g}\n", record.rows[r * columns.size() + c],
                            record.rows[r * columns.size() + c + 2]);
    blocks += "EOD\n";
    curves += fmt::format("{} $path{} with lines lw 1.5 title \"{}\"", curves.empty() ? "" : ",", c,
                          columns[c].substr(0, columns[c].size() - 4));
  }
  if (curves.empty()) return {};
  return fmt::format(
      "set terminal svg size 900,600 name 'paths' noenhanced font 'sans,12'\n"
      "set xlabel 'x, m'\nset ylabel 'z, m'\nset grid\nset size ratio -1\nset offsets graph "
      "0.05, graph 0.05, graph 0.05, graph 0.05\nset key outside top right horizontal\n{}plot{}\n",
      blocks, curves);
}

/// The residual of a system's joints, on a logarithmic axis; empty where it is always 0.
std::string joints_script(const Simulation& run, const RunRecord& record) {
  constexpr std::size_t kPoints = 4000;
  const std::vector<double>& off = record.violations;
  const std::size_t width = run.columns().size(), every = off.size() / kPoints + 1;
  std::string data;
  for (std::size_t r = 0; run.model().system.unknowns > 0 && r < off.size(); r += every)
    if (off[r] > 0.) data += fmt::format("{:.9g} {:.6g}\n", record.rows[r * width], off[r]);
  if (data.empty()) return {};
  return fmt::format(
      "set terminal svg size 900,420 name 'joints' noenhanced font 'sans,12'\n"
      "set xlabel 'time, s'\nset ylabel 'largest residual of the joints, m'\nset logscale y\n"
      "set format y '%.0e'\nset grid\n$off << EOD\n{}EOD\nplot $off with lines lw 1.5 notitle\n",
      data);
}

std::string system_plots(const Simulation& run, const RunRecord& record) {
  std::string html;
  const std::string paths = paths_script(run, record), joints = joints_script(run, record);
  if (!paths.empty()) html += fmt::format("<h2>Paths of the sensors</h2>\n{}\n", drawn(paths));
  if (!joints.empty()) html += fmt::format("<h2>Residual of the joints</h2>\n{}\n", drawn(joints));
  return html;
}

/// The rail's axis along the track, a curve a kept time; empty if the rail is not there.
std::string shapes_script(int rail, const RunRecord& record) {
  std::string blocks, curves;
  int count = 0;
  for (const RailSnapshot& shape : record.shapes) {
    if (shape.rail != rail) continue;
    const double spacing = shape.length / static_cast<double>(shape.z.size() - 1);
    blocks += fmt::format("$shape{} << EOD\n", count);
    for (std::size_t i = 0; i < shape.z.size(); ++i)
      blocks += fmt::format("{:.6g} {:.9g}\n", spacing * static_cast<double>(i), 1e3 * shape.z[i]);
    blocks += "EOD\n";
    curves += fmt::format("{} $shape{} with lines lw 1.5 title \"{:.6g} s\"", count == 0 ? "" : ",",
                          count, shape.time);
    ++count;
  }
  if (count == 0) return {};
  return fmt::format(
      "set terminal svg size 900,420 name 'rail{}' noenhanced font 'sans,12'\n"
      "set xlabel 'x, m'\nset ylabel 'height over rest, mm'\nset grid\nset key outside top right "
      "horizontal\n{}plot{}\n",
      rail, blocks, curves);
}

/// Bins of a twentieth of a decade, both axes logarithmic: rare slow frames must show.
std::string histogram_script(const RunRecord& record) {
  std::map<int, int> count;
  for (const double us : record.frame_us)
    ++count[static_cast<int>(std::floor(20. * std::log10(std::max(us, 1e-3))))];
  std::string data;
  for (const auto& [bin, frames] : count)
    data += fmt::format("{:.6g} {} {:.6g} {:.6g}\n", std::pow(10., (bin + .5) / 20.), frames,
                        std::pow(10., bin / 20.), std::pow(10., (bin + 1) / 20.));
  return fmt::format(
      "set terminal svg size 900,420 name 'frames' noenhanced font 'sans,12'\n"
      "set xlabel 'wall time of a frame, us'\nset ylabel 'frames'\nset logscale xy\n"
      "set yrange [0.5:*]\nset grid\nset style fill solid 0.5\n"
      "$bins << EOD\n{}EOD\n"
      "plot $bins using 1:2:3:4:(0.5):2 with boxxyerror notitle\n",
      data);
}

}  // namespace

std::string run_report(const std::string& title, const Simulation& run, const RunRecord& record,
                       const std::string& behaviour) {
  std::string status;
  for (const std::string& name : status_names(record.status))
    status += fmt::format("<p>{}: {}.</p>\n", name, status_sentence(name, record));
  std::string shapes;
  for (const int rail : {0, 1}) {
    const std::string script = shapes_script(rail, record);
    if (!script.empty())
      shapes += fmt::format("<h2>{} rail, its axis along the track</h2>\n{}\n",
                            rail == 0 ? "Left" : "Right", drawn(script));
  }
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{0}</title>\n"
      "<style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n{2}<table>\n"
      "<tr><th>frames</th><th>dt, s</th><th>frame median, us</th><th>p99, us</th><th>max, us</th>"
      "</tr>\n<tr><td>{3}</td><td>{4:.6g}</td><td>{5:.3g}</td><td>{6:.3g}</td><td>{7:.3g}</td>"
      "</tr>\n</table>\n{8}{9}<h2>Wall time of a frame</h2>\n"
      "{10}\n</body>\n</html>\n",
      escaped(title), kReportStyle, status, run.state.steps / run.model().steps_per_frame,
      run.model().scheme.dt, quantile(record.frame_us, .5), quantile(record.frame_us, .99),
      record.slowest_us, behaviour + system_plots(run, record) + all_curves(run.columns(), record),
      shapes, drawn(histogram_script(record)));
}

}  // namespace railstep
