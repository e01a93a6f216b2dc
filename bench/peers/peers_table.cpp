// Times peers on the same work in turns in one process, each with its error (docs/peers.md). CSV on
// stdout, remarks on stderr.
//
// Usage: peers_table [SCENE ...]   moving_load, moving_load_in_time, double_pendulum; default: all
//        peers_table --references FOLDER   writes what other codes' programs compare with
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "contest.h"
#include "peer_moving_load.h"

namespace {

constexpr int kRounds = 31;
constexpr int kElements[] = {4, 16, 64, 256};  // of a rail, 0.6 m each

void hold(std::vector<railstep::Contestant> all, int rounds) {
  railstep::hold_contest(all, rounds);
  railstep::print_rows(all);
}

bool hold(const std::string& scene) {
  if (scene == "moving_load")
    for (const int elements : kElements) hold(railstep::moving_load_contest(elements), kRounds);
  else if (scene == "moving_load_in_time")
    hold(railstep::work_precision_contest(16), 7);  // a passage of some peers takes seconds
  else if (scene == "double_pendulum")
    hold(railstep::double_pendulum_contest(), kRounds);
  else
    return false;
  return true;
}

/// moving_load_N.csv: deflections under the load every 1 ms from the first step's end on.
void write_references(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const int bays : kElements) {
    const railstep::PassageReference& known =
        railstep::reference_for(bays, railstep::Unknowns::vertical);
    std::ofstream out(folder / ("moving_load_" + std::to_string(bays) + ".csv"));
    out.precision(17);
    out << "# own_error=" << known.own_error << "\ntime_s,deflection_z_m\n";
    for (std::size_t i = 0; i < known.z.size(); ++i)
      out << static_cast<double>(i + 1) * railstep::kStep << ',' << known.z[i] << '\n';
    if (!out) throw std::runtime_error("cannot write into " + folder.string());
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> scenes(argv + 1, argv + argc);
  if (scenes.size() == 2 && scenes[0] == "--references") {
    write_references(scenes[1]);
    return 0;
  }
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
