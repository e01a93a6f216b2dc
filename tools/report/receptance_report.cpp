#include "report/receptance_report.h"

#include <fmt/core.h>

#include <cmath>

#include "report/drawing.h"
#include "text/message_json.h"

namespace railstep {
namespace {

std::vector<const ReceptanceCurve*> curves_of(const ReceptanceAnswer& answer) {
  std::vector<const ReceptanceCurve*> all = {&answer.curve};
  for (const ReceptanceCurve& curve : answer.beside) all.push_back(&curve);
  return all;
}

/// In (-pi, pi]: atan2 gives -pi for -0 imaginary parts.
double phase(const std::complex<double>& value) {
  const double angle = std::arg(value);
  return angle > -M_PI ? angle : M_PI;
}

void put(const ReceptanceCurve& curve, nlohmann::ordered_json& json) {
  std::vector<double> magnitude, angle;
  for (const std::complex<double>& value : curve.value) {
    magnitude.push_back(std::abs(value));
    angle.push_back(phase(value));
  }
  json["magnitude_m_per_n"] = magnitude;
  json["phase_rad"] = angle;
}

const char* long_name(const std::string& model) {
  if (model == "full") return "full order";
  if (model == "condensed") return "condensed";
  if (model == "euler") return "Euler-Bernoulli";
  return "Timoshenko, without end";
}

std::string resonance_line(const Resonance& one) {
  if (!one.found)
    return fmt::format("{:<24} expected near {:.4g} Hz, not seen", one.name, one.expected_hz);
  return fmt::format("{:<24} {:.5g} Hz, {:.4g} m/N ({}; one bay alone {:.4g} Hz)", one.name,
                     one.found->hz, one.found->magnitude, one.found->peak ? "peak" : "dip",
                     one.expected_hz);
}

std::string decay_line(const DecayRate& rate) {
  return fmt::format("{:>9} {:>12.4g} {:>12.4g}{}", rate.band.nominal_hz, rate.rate, rate.drop_db,
                     rate.suitable ? "" : "  upper bound");
}

/// A value's block of data for gnuplot, one column a curve.
std::string block(const ReceptanceAnswer& answer, double (*of)(const std::complex<double>&)) {
  std::string data;
  for (std::size_t i = 0; i < answer.hz.size(); ++i) {
    data += fmt::format("{:.9g}", answer.hz[i]);
    for (const ReceptanceCurve* curve : curves_of(answer))
      data += fmt::format(" {:.9g}", of(curve->value[i]));
    data += '\n';
  }
  return data;
}

constexpr const char* kStyles =
    "set style line 1 lc rgb '#1f4e8c' lw 4\nset style line 2 lc rgb '#d1495b' lw 1.5\n"
    "set style line 3 lc rgb '#2a9d5c' lw 1.5\nset style line 4 lc rgb '#8a6d3b' lw 1.5\n"
    "set grid xtics ytics lc rgb '#dddddd'\nset tics nomirror\nset border 3\n";

std::string plot_of(const ReceptanceAnswer& answer, const std::string& settings,
                    double (*of)(const std::complex<double>&)) {
  std::string plot;
  int column = 2;
  for (const ReceptanceCurve* curve : curves_of(answer)) {
    plot += fmt::format("{} $d using 1:{} with lines ls {} title \"{}\"", plot.empty() ? "" : ",",
                        column, column - 1, long_name(curve->name));
    ++column;
  }
  const bool log = answer.hz.back() > 3. * answer.hz.front();
  return drawn(fmt::format(
      "set terminal svg size 900,420 noenhanced font 'sans,12' background '#ffffff'\n{}{}\n"
      "set xrange [{}:{}]\nset xlabel 'frequency, Hz'\n{}"
      "$d << EOD\n{}EOD\nplot{}\n",
      kStyles, log ? "set logscale x" : "", answer.hz.front(), answer.hz.back(), settings,
      block(answer, of), plot));
}

double magnitude_nm(const std::complex<double>& value) { return 1e9 * std::abs(value); }
double phase_degrees(const std::complex<double>& value) { return phase(value) * 180. / M_PI; }

/// Vertical marks at the resonances that were found.
std::string marks(const ReceptanceAnswer& answer) {
  std::string script;
  for (const Resonance& one : answer.resonances)
    if (one.found)
      script += fmt::format(
          "set arrow from first {0:.6g}, graph 0 to first {0:.6g}, graph 1 nohead lc rgb "
          "'#aaaaaa' dt 3\nset label \"{1}\" at first {0:.6g}, graph 0.02 rotate by 90 left offset "
          "-0.6,0 font ',10' textcolor rgb '#666666'\n",
          one.found->hz, one.name);
  return script;
}

std::string decay_plot(const ReceptanceAnswer& answer) {
  std::string data, tics;
  for (std::size_t i = 0; i < answer.decay.size(); ++i) {
    data += fmt::format("{} {:.6g}\n", i, answer.decay[i].rate);
    tics += fmt::format("{}'{}' {}", i > 0 ? ", " : "", answer.decay[i].band.nominal_hz, i);
  }
  return drawn(fmt::format(
      "set terminal svg size 900,360 noenhanced font 'sans,12' background '#ffffff'\n{}"
      "set logscale y\nset format y '%g'\nset xtics ({})\nset xrange [-0.5:{}]\nset xlabel "
      "'one-third octave band, Hz'\n"
      "set ylabel 'decay rate, dB/m'\n$d << EOD\n{}EOD\nplot $d using 1:2 with linespoints ls 1 pt "
      "7 notitle\n",
      kStyles, tics, static_cast<double>(answer.decay.size()) - .5, data));
}

}  // namespace

nlohmann::ordered_json to_json(const ReceptanceAnswer& answer) {
  nlohmann::ordered_json json = {{"frequency_hz", answer.hz}};
  put(answer.curve, json);
  json["model"] = answer.curve.name;
  for (const ReceptanceCurve& curve : answer.beside) put(curve, json["beside"][curve.name]);
  if (!answer.end_effect.empty()) json["end_effect"] = answer.end_effect;
  for (const Resonance& one : answer.resonances)
    json["resonances"].push_back(
        {{"name", one.name},
         {"expected_hz", one.expected_hz},
         {"frequency_hz", one.found ? nlohmann::ordered_json(one.found->hz) : nullptr},
         {"magnitude_m_per_n",
          one.found ? nlohmann::ordered_json(one.found->magnitude) : nullptr}});
  if (!answer.decay.empty()) {
    nlohmann::ordered_json& decay = json["decay_rate"];
    decay["distance_m"] = answer.decay_distance;
    for (const DecayRate& rate : answer.decay) {
      decay["band_hz"].push_back(rate.band.nominal_hz);
      decay["db_per_m"].push_back(rate.rate);
      decay["upper_bound"].push_back(!rate.suitable);
    }
  }
  for (const Reflection& end : answer.reflection) {
    json["reflection"].push_back(end.back);
    json["wave_decay_per_bay"].push_back(end.decay);
  }
  json["warnings"] = to_json(answer.warnings);
  return json;
}

std::string to_table(const ReceptanceAnswer& answer) {
  std::string text = fmt::format("{} per newton on {}\nfrequency, Hz  magnitude, m/N  phase, rad",
                                 answer.read, answer.force);
  for (const ReceptanceCurve& curve : answer.beside)
    text += fmt::format("  {:>24}", long_name(curve.name));
  if (!answer.reflection.empty()) text += "  reflection";
  text += '\n';
  for (std::size_t i = 0; i < answer.hz.size(); ++i) {
    const std::complex<double>& value = answer.curve.value[i];
    text +=
        fmt::format("{:13.6g}  {:14.6g}  {:10.5f}", answer.hz[i], std::abs(value), phase(value));
    for (const ReceptanceCurve& curve : answer.beside)
      text += fmt::format("  {:>13.6g} {:10.5f}", std::abs(curve.value[i]), phase(curve.value[i]));
    if (!answer.reflection.empty()) text += fmt::format("  {:10.3g}", answer.reflection[i].back);
    text += '\n';
  }
  for (const Resonance& one : answer.resonances) text += resonance_line(one) + '\n';
  if (!answer.decay.empty()) text += " band, Hz   decay, dB/m  drop, dB\n";
  for (const DecayRate& rate : answer.decay) text += decay_line(rate) + '\n';
  for (const Message& warning : answer.warnings)
    text += fmt::format("warning: {}\n", warning.line());
  return text;
}

std::string to_csv(const ReceptanceAnswer& answer) {
  std::string text = "frequency_hz";
  for (const ReceptanceCurve* curve : curves_of(answer))
    text += fmt::format(",{0}.magnitude_m_per_n,{0}.phase_rad", curve->name);
  if (!answer.end_effect.empty()) text += ",end_effect";
  if (!answer.reflection.empty()) text += ",reflection,wave_decay_per_bay";
  text += '\n';
  for (std::size_t i = 0; i < answer.hz.size(); ++i) {
    text += fmt::format("{:.17g}", answer.hz[i]);
    for (const ReceptanceCurve* curve : curves_of(answer))
      text += fmt::format(",{:.17g},{:.17g}", std::abs(curve->value[i]), phase(curve->value[i]));
    if (!answer.end_effect.empty()) text += fmt::format(",{:.17g}", answer.end_effect[i]);
    if (!answer.reflection.empty())
      text +=
          fmt::format(",{:.17g},{:.17g}", answer.reflection[i].back, answer.reflection[i].decay);
    text += '\n';
  }
  return text;
}

std::string to_html(const ReceptanceAnswer& answer, const std::string& title) {
  std::string warnings, resonances, decay;
  for (const Message& warning : answer.warnings)
    warnings += fmt::format("<p>Warning: {}.</p>\n", escaped(warning.line()));
  for (const Resonance& one : answer.resonances)
    resonances += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.4g}</td></tr>\n", one.name,
        one.found ? fmt::format("{:.5g}", one.found->hz) : "not seen",
        one.found ? fmt::format("{:.4g}", 1e9 * one.found->magnitude) : "-", one.expected_hz);
  if (!resonances.empty())
    resonances =
        "<h2>Resonances</h2>\n<table><tr><th></th><th>Hz</th><th>nm/N</th><th>one bay alone, "
        "Hz</th></tr>\n" +
        resonances + "</table>\n";
  if (!answer.decay.empty())
    decay =
        fmt::format("<h2>Track decay rate (EN 15461), {} positions over {:.4g} m</h2>\n{}\n",
                    answer.decay_distance.size(), answer.decay_distance.back(), decay_plot(answer));
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{0}</title>\n"
      "<style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n<p>{2} per newton on {3}, times "
      "e<sup>+i&omega;t</sup>.</p>\n{4}<h2>Magnitude</h2>\n{5}\n<h2>Phase</h2>\n{6}\n{7}{8}"
      "</body>\n</html>\n",
      escaped(title), kReportStyle, escaped(answer.read), escaped(answer.force), warnings,
      plot_of(answer, "set logscale y\nset format y '%g'\nset ylabel 'nm/N'\n" + marks(answer),
              magnitude_nm),
      plot_of(answer, "set yrange [-180:180]\nset ytics 45\nset ylabel 'degrees'\n", phase_degrees),
      resonances, decay);
}

}  // namespace railstep
