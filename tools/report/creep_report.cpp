#include "report/creep_report.h"

#include <fmt/core.h>

#include "report/drawing.h"

namespace railstep {
namespace {

std::string plot_of(const CreepRequest& request, char over) {
  const CreepCurves all = creep_curves(request, over);
  std::string blocks, plot;
  for (std::size_t c = 0; c < all.curves.size(); ++c) {
    blocks += fmt::format("$d{} << EOD\n", c);
    for (std::size_t i = 0; i < all.at.size(); ++i)
      blocks += fmt::format("{:.6g} {:.6g}\n", all.at[i],
                            over == 'x' ? -all.curves[c].x[i] : -all.curves[c].y[i]);
    blocks += "EOD\n";
    plot += fmt::format("{} $d{} using 1:2 with lines lw 2.5 dt {} lc {} title '{}'",
                        c == 0 ? "" : ",", c, c + 1, c + 1, all.curves[c].name);
  }
  return drawn(fmt::format(
      "set terminal svg size 900,380 noenhanced font 'sans,12' background '#ffffff'\n"
      "set grid xtics ytics lc rgb '#dddddd'\nset tics nomirror\nset border 3\nset key tmargin "
      "center horizontal\n"
      "set linetype 1 lc rgb '#1f4e8c'\nset linetype 2 lc rgb '#d1495b'\nset linetype 3 lc rgb "
      "'#e8a33d'\nset linetype 4 lc rgb '#2a9d5c'\nset linetype 5 lc rgb '#777777'\n"
      "set yrange [:1.3]\nset xlabel 'normalised creepage {}'\nset ylabel '-F{} / (mu "
      "N)'\n{}plot{}\n",
      over, over == 'x' ? 'x' : 'y', blocks, plot));
}

std::string figure(const CreepRequest& request, char over, const char* name) {
  std::string others;
  for (const auto& [key, value] : {std::pair('x', request.x), {'e', request.e}, {'p', request.p}})
    if (key != over) others += fmt::format("{}{} = {:.4g}", others.empty() ? "" : ", ", key, value);
  return fmt::format("<h2>Over {}, {}</h2>\n{}\n", name, others, plot_of(request, over));
}

}  // namespace

std::string creep_page(const CreepRequest& r) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>Creep "
      "forces</title>"
      "\n<style>{}</style></head>\n<body>\n<h1>Creep forces, a/b = {:.4g}, nu = {:.4g}</h1>\n"
      "<p>Force on the wheel over friction times normal force. With half lengths a along the rail "
      "and "
      "b across, x = 4 G ab xi/(mu N), e = 4 G ab eta/(mu N), p = 2 G (ab)<sup>1.5</sup> "
      "phi/(mu N).</p>\n{}{}{}</body>\n</html>\n",
      kReportStyle, r.ratio, r.poisson, figure(r, 'x', "the longitudinal creepage x"),
      figure(r, 'e', "the lateral creepage e"), figure(r, 'p', "the spin p"));
}

}  // namespace railstep
