#include "text/progress_bar.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace railstep {
namespace {

constexpr int kLook = 10;          // percent that the pace is taken from
constexpr double kShownTime = 2.;  // s; less is not worth a word

}  // namespace

void Pace::reached(int percent, double seconds) {
  percent = std::clamp(percent, percent_, 100);
  for (int p = percent_ + 1; p <= percent; ++p) at_[static_cast<std::size_t>(p)] = seconds;
  percent_ = percent;
}

double Pace::left() const {
  const int from = std::max(0, percent_ - kLook);
  if (percent_ == from) return 0.;
  const double took = at_[static_cast<std::size_t>(percent_)] - at_[static_cast<std::size_t>(from)];
  return took * (100 - percent_) / (percent_ - from);
}

std::string duration_text(double seconds) {
  if (seconds < 100.) return fmt::format("{:.0f} s", seconds);
  const auto minutes = static_cast<std::int64_t>(std::ceil(seconds / 60.));
  return minutes < 100 ? fmt::format("{} min", minutes)
                       : fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

Progress::Progress(std::int64_t all) : all_(all), shown_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_ && percent_ >= 0) std::fputs("\r\033[K", stderr);
}

void Progress::operator()(std::int64_t done) {
  const int percent =
      static_cast<int>(100. * static_cast<double>(done) / static_cast<double>(all_));
  if (!shown_ || percent == percent_) return;
  percent_ = percent;
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
  pace_.reached(percent, passed.count());
  const double left = pace_.left();
  const auto full = static_cast<std::size_t>(percent / 4);
  fmt::print(stderr, "\r[{}{}] {:3d} %{}\033[K", std::string(full, '#'),
             std::string(25 - full, ' '), percent,
             left > kShownTime ? ", about " + duration_text(left) + " left" : "");
}

}  // namespace railstep
