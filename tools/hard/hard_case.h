#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace railstep {

/// A figure of a case that has to stay within its bound: an error, a growth, a count.
struct HardCheck {
  std::string what;
  double figure, bound;                                          // of one unit
  [[nodiscard]] bool passed() const { return figure <= bound; }  // NaN does not
};

/// A curve of a case's picture.
struct HardCurve {
  std::string name;
  std::vector<double> x, y;
  bool points = false;  // marks rather than a line
};

/// The response that a case's page shows.
struct HardPicture {
  std::string x_label, y_label;
  std::vector<HardCurve> curves;
  bool log_x = false, log_y = false;
};

struct HardResult {
  std::vector<HardCheck> checks;
  HardPicture picture;
  double frame_us = 0.;  // median; 0: the case steps nothing
};

/// A hard case: a scene that a simulator of this kind may break at, and what is asked of it.
struct HardCase {
  const char* id;      // "H1": that of its test, too
  const char* scene;   // its file in config/hard, without ".toml"
  const char* title;   // a few words
  const char* why;     // what is hard about it
  const char* source;  // where its figures come from
  HardResult (*run)(const std::filesystem::path& scene);
};

/// All of them, in the order of the page. Each list is that of the file hard/<part>_cases.cpp.
std::vector<HardCase> hard_cases();
std::vector<HardCase> contact_cases();
std::vector<HardCase> element_cases();
std::vector<HardCase> input_cases();
std::vector<HardCase> joint_cases();
std::vector<HardCase> model_cases();
std::vector<HardCase> profile_cases();
std::vector<HardCase> stability_cases();
std::vector<HardCase> step_cases();
std::vector<HardCase> support_cases();
std::vector<HardCase> suspension_cases();
std::vector<HardCase> vehicle_cases();
std::vector<HardCase> track_cases();
std::vector<HardCase> traffic_cases();
std::vector<HardCase> wheel_cases();

/// The check that is nearest to its bound, or furthest over it.
const HardCheck& tightest(const HardResult& result);

/// |value - expected| over |expected|.
HardCheck off_by(std::string what, double value, double expected, double bound);
/// |value - expected|.
HardCheck apart_by(std::string what, double value, double expected, double bound);
/// Something that is true or not: 0 or 1, of a bound of 0.
HardCheck holds(std::string what, bool is_true);

}  // namespace railstep
