// Peers on the same work, timed in turns in one process, each with its error (docs/peers.md). CSV
// on stdout, remarks on stderr. Usage: peers_table [SCENE ...]   moving_load, moving_load_in_time,
// double_pendulum; default: all
#include <cstdio>
#include <string>
#include <vector>

#include "contest.h"

namespace {

constexpr int kRounds = 31;

void hold(std::vector<railstep::Contestant> all, int rounds) {
  railstep::hold_contest(all, rounds);
  railstep::print_rows(all);
}

bool hold(const std::string& scene) {
  if (scene == "moving_load")
    for (const int elements : {4, 16, 64, 256})
      hold(railstep::moving_load_contest(elements), kRounds);
  else if (scene == "moving_load_in_time")
    hold(railstep::work_precision_contest(16), 7);  // a passage of some takes seconds
  else if (scene == "double_pendulum")
    hold(railstep::double_pendulum_contest(), kRounds);
  else
    return false;
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> scenes(argv + 1, argv + argc);
  if (scenes.empty()) scenes = {"moving_load", "moving_load_in_time", "double_pendulum"};
  railstep::print_head();
  for (const std::string& scene : scenes)
    if (!hold(scene)) {
      std::fprintf(stderr,
                   "error: no scene %s; there are moving_load, moving_load_in_time and "
                   "double_pendulum\n",
                   scene.c_str());
      return 2;
    }
  return 0;
}
