#include "scene/scene_irregularity.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "offline/irregularity/defect.h"
#include "scene/scene_read.h"

namespace railstep {
namespace {

constexpr double kTwoPi = 6.28318530717958647692;
const Range kPatch = between(0.0, 0.5);
const Range kDefectHeight = between(-0.1, 0.1);

/// Range of a cosine wave's amplitude, so that it is nowhere steeper than 45 degrees.
Range wave_height(double wavelength) {
  const double most = std::min(0.1, wavelength / kTwoPi);
  return between(-most, most);
}

constexpr double kEndlessPeriod = 1000.;  // m

/// Reads which of the two sides, or both.
std::array<bool, 2> read_sides(const Table& t, std::string_view key, const Scene& scene) {
  if (scene.track.rails == 1 && !t.has(key)) return {true, false};
  const std::size_t side = t.choice(key, {"both", "left", "right"}, 0);
  if (scene.track.rails == 1 && side != 1)
    t.refuse(key, "E-IRREGULARITY-22",
             fmt::format("the track has one rail; expected {} = \"left\"", key));
  return {side != 2, side != 1};
}

/// Refuses a wave that is passed in less than eight steps.
void check_wave(const Table& t, std::string_view key, double wavelength, double speed,
                const Scene& scene) {
  if (!scene.step || wavelength >= 8. * speed * scene.step->dt * (1. - 1e-12)) return;
  t.refuse(key, "E-IRREGULARITY-23",
           fmt::format("a wave of {:.6g} m is passed at {:.6g} m/s in {:.3g} steps of dt_s = "
                       "{:.6g}; expected 8 steps or more, by a shorter step.dt_s or a longer "
                       "wave",
                       wavelength, speed, wavelength / (speed * scene.step->dt), scene.step->dt));
}

/// Refuses a defect with more samples than a signal may hold.
/// @param key    the key of its length
/// @param half   half of its span, m
/// @param shape  length that its samples have to resolve beside the contact patch, m
void check_samples(const Table& t, std::string_view key, double half, double patch, double shape) {
  const double step = defect_grid(patch, shape).step;
  if (std::max(half, patch) < kMostDefectSteps * step) return;
  const bool of_patch = patch > 0. && step < shape / 50.;
  t.refuse(of_patch ? "contact_patch_m" : key, "E-IRREGULARITY-24",
           fmt::format("{}: a contact patch of {:.6g} m and a shape of {:.6g} m need samples "
                       "{:.3g} m apart, which are too many over {:.6g} m; expected at most {:g} "
                       "samples",
                       of_patch ? "contact_patch_m" : key, patch, shape, step, 2. * half,
                       2. * kMostDefectSteps));
}

/// The names of the geometries that a spectrum has.
std::vector<std::string> geometries_of(const TrackSpectra& spectra) {
  std::vector<std::string> names;
  for (std::size_t g = 0; g < kGeometries; ++g)
    if (spectra.of[g].factor > 0.) names.emplace_back(kGeometryNames[g]);
  return names;
}

std::vector<Geometry> read_geometries(const Table& t, const Scene& scene,
                                      const TrackSpectra& spectra) {
  const std::vector<std::string> given = geometries_of(spectra);
  std::vector<std::string> wanted = given;
  if (t.has("geometries")) {
    wanted = t.strings("geometries", 1, kGeometries);
  } else if (scene.track.unknowns == Unknowns::vertical || scene.track.rails == 1) {
    std::erase_if(wanted, [](const std::string& name) { return name != "vertical"; });
  }
  std::vector<Geometry> found;
  for (const std::string& name : wanted) {
    const auto* const known = std::find(std::begin(kGeometryNames), std::end(kGeometryNames), name);
    if (known == std::end(kGeometryNames) || std::count(given.begin(), given.end(), name) == 0)
      t.refuse("geometries", "E-IRREGULARITY-25",
               fmt::format("geometries: \"{}\" is not a geometry of {}; expected names of \"{}\"",
                           name, spectra.name, fmt::join(given, "\", \"")));
    const auto geometry = static_cast<Geometry>(known - std::begin(kGeometryNames));
    if (std::count(found.begin(), found.end(), geometry) > 0)
      t.refuse("geometries", "E-IRREGULARITY-26",
               fmt::format("geometries: \"{}\" is given twice; expected each name once", name));
    found.push_back(geometry);
  }
  return found;
}

void read_generated(const Table& t, const Scene& scene, IrregularityScene& own) {
  own.spectrum = t.string("spectrum");
  const TrackSpectra* spectra = find_spectra(own.spectrum);
  if (spectra == nullptr) {
    std::vector<std::string> names;
    for (const TrackSpectra& known : track_spectra()) names.push_back(known.name);
    t.refuse("spectrum", "E-IRREGULARITY-27",
             fmt::format("spectrum = \"{}\" is unknown; expected one of \"{}\"", own.spectrum,
                         fmt::join(names, "\", \"")));
  }
  own.geometries = read_geometries(t, scene, *spectra);
  GenerateOptions& o = own.options;
  o.seed = static_cast<std::uint64_t>(t.integer("seed", 0, INT64_MAX, 1));
  constexpr double kLongest = 25.0;
  const double most = t.has("longest_wavelength_m") ? 1e3 : kLongest;
  o.shortest = t.number("shortest_wavelength_m", between(0.01, most), 3.0);
  o.longest = t.number("longest_wavelength_m", between(o.shortest, 1e3), kLongest);
  o.length = t.number(
      "period_m", between(o.longest, 1e6),
      std::max(scene.track.endless ? kEndlessPeriod : scene.track.length(), 4. * o.longest));
  check_wave(t, "shortest_wavelength_m", o.shortest, fastest_wheel(scene), scene);
}

}  // namespace

std::optional<IrregularityScene> read_irregularity(const Table& root, const Scene& scene) {
  const std::optional<Table> t = root.table_if("irregularity");
  if (!t) return std::nullopt;
  if (!has_wheels(scene))
    t->refuse("", "E-IRREGULARITY-28",
              "no wheel feels the irregularity; expected a [[wheelset]] or a "
              "[[vehicle]]");
  if (t->has("file") == t->has("spectrum"))
    t->refuse("", "E-IRREGULARITY-29",
              t->has("file") ? "file is given beside spectrum; expected exactly one of them"
                             : "neither file nor spectrum is given; expected exactly one of them");
  IrregularityScene own;
  if (t->has("file"))
    own.file = t->path("file");
  else
    read_generated(*t, scene, own);
  own.options.patch = t->number("contact_patch_m", kPatch, kContactPatch);
  return own;
}

std::vector<DefectScene> read_defects(const Table& root, const Scene& scene) {
  std::vector<DefectScene> defects;
  root.each("defect", [&](const Table& t) {
    if (!has_wheels(scene))
      t.refuse("", "E-IRREGULARITY-30",
               "no wheel feels the defect; expected a [[wheelset]] or a [[vehicle]]");
    DefectScene d{};
    d.kind = t.choice("kind", {"dipped_joint", "corrugation"}) == 0 ? DefectKind::dipped_joint
                                                                    : DefectKind::corrugation;
    d.on = read_sides(t, "rail", scene);
    d.patch = t.number("contact_patch_m", kPatch, kContactPatch);
    const Range on_rail = between(0.0, scene.track.endless ? 1e9 : scene.track.length());
    if (d.kind == DefectKind::dipped_joint) {
      d.at = t.number("at_m", on_rail);
      d.depth = t.number("depth_m", kDefectHeight);
      d.ramp = t.number("ramp_m", between(1e-4, 100.0));
      check_samples(t, "ramp_m", d.ramp, d.patch, d.ramp);
    } else {
      d.length = t.number("wavelength_m", above_upto(1e-3, 100.0));
      d.amplitude = t.number("amplitude_m", wave_height(d.length));
      d.from = t.number("from_m", on_rail);
      d.to = t.number("to_m", between(d.from + 2. * d.length, 1e9));
      check_samples(t, "to_m", .5 * (d.to - d.from), d.patch, d.length);
      check_wave(t, "wavelength_m", d.length, fastest_wheel(scene), scene);
    }
    defects.push_back(d);
  });
  return defects;
}

namespace {

/// Reads how a wheel of this radius and speed deviates from round. The caller reads which wheel.
TreadScene read_tread(const Table& t, const Scene& scene, double radius, double speed) {
  TreadScene d{};
  constexpr TreadKind kKinds[] = {TreadKind::fresh_flat, TreadKind::rounded_flat,
                                  TreadKind::out_of_round};
  d.kind = kKinds[t.choice("kind", {"fresh_flat", "rounded_flat", "out_of_round"})];
  d.first = t.number("first_m", between(0.0, 1e6), .5 * kTwoPi * radius);
  d.patch = t.number("contact_patch_m", kPatch, kContactPatch);
  double wave;
  if (d.kind == TreadKind::out_of_round) {
    d.order = static_cast<int>(t.integer("order", 1, 200));
    wave = kTwoPi * radius / d.order;
    d.amplitude = t.number("amplitude_m", wave_height(wave));
  } else {
    wave = d.length = t.number("length_m", above_upto(0.0, .9 * radius));
    if (d.kind == TreadKind::rounded_flat)
      d.depth = t.number("depth_m", above_upto(0.0, 0.1), d.length * d.length / (16. * radius));
  }
  const char* const key = d.kind == TreadKind::out_of_round ? "order" : "length_m";
  check_wave(t, key, wave, std::fabs(speed), scene);
  check_samples(t, key, .5 * kTwoPi * radius, d.patch, wave);
  return d;
}

}  // namespace

std::vector<WheelTread> read_wheel_treads(const Table& vehicle, const Scene& scene,
                                          const VehicleScene& own) {
  std::vector<WheelTread> treads;
  const std::vector<Vehicle::Wheel>& wheels = own.vehicle.wheels;
  for (const Table& t : vehicle.tables("tread")) {
    const auto wheel = static_cast<std::size_t>(
        t.integer("wheel", 1, static_cast<std::int64_t>(wheels.size())) - 1);
    for (const WheelTread& other : treads)
      if (other.wheel == wheel)
        t.refuse(
            "wheel", "E-IRREGULARITY-31",
            fmt::format("wheel {} has a [[vehicle.tread]] already; expected at most one for each "
                        "wheel",
                        wheel + 1));
    const double radius = wheels[wheel].radius;
    treads.push_back({wheel, read_tread(t, scene, radius, fastest(own)), radius});
  }
  return treads;
}

std::vector<TreadScene> read_treads(const Table& wheelset, const Scene& scene,
                                    const WheelsetScene& own) {
  std::vector<TreadScene> treads;
  std::array<bool, 2> taken = {false, false};
  for (const Table& t : wheelset.tables("tread")) {
    TreadScene d = read_tread(t, scene, own.radius, fastest(own));
    d.on = read_sides(t, "wheel", scene);
    for (std::size_t side = 0; side < 2; ++side) {
      if (d.on[side] && taken[side])
        t.refuse(
            "wheel", "E-IRREGULARITY-32",
            fmt::format("the {} wheel has a [[wheelset.tread]] already; expected at most one for "
                        "each wheel",
                        side == 0 ? "left" : "right"));
      taken[side] = taken[side] || d.on[side];
    }
    treads.push_back(d);
  }
  return treads;
}

}  // namespace railstep
