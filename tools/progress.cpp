#include "progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace railstep {

Progress::Progress(std::int64_t all) : all_(all), shown_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_ && percent_ >= 0) std::fputs("\r\033[K", stderr);
}

void Progress::operator()(std::int64_t done) {
  const int percent =
      static_cast<int>(100. * static_cast<double>(done) / static_cast<double>(all_));
  if (!shown_ || percent == percent_) return;
  percent_ = percent;
  const auto full = static_cast<std::size_t>(percent / 4);
  fmt::print(stderr, "\r[{}{}] {:3d} %", std::string(full, '#'), std::string(25 - full, ' '),
             percent);
}

}  // namespace railstep
