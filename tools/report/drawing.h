#pragma once
#include <string>

namespace railstep {

/// Throws Failed where gnuplot cannot be run.
void need_gnuplot();

/// The drawing that gnuplot makes of a script, from its <svg> on. The script's text stays out of
/// the shell. Throws Failed where gnuplot fails.
std::string drawn(const std::string& script);

/// Text as it may stand in HTML.
std::string escaped(const std::string& text);

/// CSS of report pages.
inline constexpr const char* kReportStyle =
    "body{font:15px/1.5 sans-serif;max-width:960px;margin:2em auto;padding:0 1em}"
    "svg{width:100%;height:auto}td,th{text-align:left;padding-right:2em}";

}  // namespace railstep
