// Laws of symmetry: a scene and its image move alike.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "generators.h"
#include "properties.h"
#include "transform.h"

namespace railstep::property {

bool is_track_alone(const Document& scene) {
  return scene.contains("track") && !scene.contains("body") && !scene.contains("beam");
}
bool is_condensed(const Document& scene) {
  return scene.contains("condense") && scene["condense"].contains("kind") &&
         scene["condense"]["kind"] != "full";
}
bool is_endless(const Document& scene) {
  return scene.contains("track") && scene["track"].contains("length");
}
bool has_one_sided(const Document& scene) {
  for (const char* table : {"support", "ballast"})
    if (scene.contains(table) &&
        (scene[table].contains("unilateral") || scene[table].contains("gap_m")))
      return true;
  if (scene.contains("stop")) return true;
  for (const Document& change : tables(scene, "support_change"))
    for (const char* table : {"support", "ballast"})
      if (change.contains(table) &&
          (change[table].contains("gap_m") || change[table].contains("unilateral")))
        return true;
  for (const Document& joint : tables(scene, "rail_joint"))
    if (joint.contains("gap_m")) return true;
  return false;
}
bool has_hertz(const Document& scene) {
  if (!tables(scene, "wheelset").empty()) return true;
  const Document& all = tables(scene, "vehicle");
  return std::any_of(all.begin(), all.end(),
                     [](const Document& v) { return word(v, "contact", "hertz") == "hertz"; });
}

bool has_bonded(const Document& scene) {
  for (const Document& v : tables(scene, "vehicle"))
    if (word(v, "contact", word(v, "type") == "mass" ? "bonded" : "hertz") == "bonded") return true;
  return false;
}

double rounding_of(const Document& scene) {
  return has_bonded(scene) ? 1e-5 : is_condensed(scene) ? 1e-6 : 1e-8;
}

double allowed(const Document& scene, const Trace& trace, double floor) {
  try {
    return std::max(floor, kJiggles * apart(trace, trace_of(jiggled(scene, kJiggle))).largest);
  } catch (const InputError&) {
    return floor;
  }
}

Outcome compared(const Document& scene, const Trace& trace, const Document& other,
                 const ImageOf& image, double floor) {
  Trace there;
  try {
    there = trace_of(other);
  } catch (const InputError& refusal) {
    return Outcome::of(
        false, std::string("the scene is accepted and its image refused: ") + refusal.what());
  }
  const Distance distance = apart(trace, there, image);
  const double bound = distance.largest > floor ? allowed(scene, trace, floor) : floor;
  const bool alike = distance.largest <= bound;
  if (alike && bound == floor && trace.status != there.status)
    return Outcome::of(false,
                       fmt::format("status {:#x} and {:#x}", static_cast<unsigned>(trace.status),
                                   static_cast<unsigned>(there.status)));
  return Outcome::of(alike, fmt::format("{}; allowed {:.2g}", distance.text(), bound));
}

namespace {

Outcome reflected_alike(const Document& own, int axis) {
  const Document scene = without_scatter(own, axis);
  const Trace trace = trace_of(scene);
  const Transformed other = reflected(scene, axis);
  return compared(scene, trace, other.scene, other.image, rounding_of(scene));
}

/// Whether a length has no key: the gauge line 14 mm below the head, or 0.1 m over the axis, where
/// the forces act whose responses are Krylov's basis.
bool has_fixed_lengths(const Document& scene) {
  if (is_condensed(scene) && scene["condense"]["kind"] == "krylov") return true;
  for (const Document& w : tables(scene, "wheelset"))
    if (w.contains("flange")) return true;
  return false;
}

/// The scene with all numbers with units that it may leave out.
Document with_defaults(const Document& scene) {
  Document full = scene;
  const auto fill = [](Document& table, const char* key, double value) {
    if (!table.contains(key)) table[key] = value;
  };
  if (full.contains("rail")) {
    fill(full["rail"], "young_pa", 210e9);
    fill(full["rail"], "density_kg_per_m3", 7850.);
    fill(full["rail"], "crown_radius_m", .3);
  }
  if (full.contains("condense") && !full["condense"].contains("band_hz"))
    full["condense"]["band_hz"] = {20., 1500.};
  for (Document& w : full["wheelset"]) fill(w, "tread_half_width_m", .065);
  for (Document& v : full["vehicle"]) fill(v, "radius_m", .46);
  for (const char* carriers : {"wheelset", "vehicle"})
    for (Document& carrier : full[carriers])
      for (Document& tread : carrier["tread"]) fill(tread, "contact_patch_m", .012);
  for (Document& defect : full["defect"]) fill(defect, "contact_patch_m", .012);
  return full;
}

constexpr const char* kManyRests = "of many equilibria the search finds another one";

Outcome rescaled_alike(const Document& own, const Units& units) {
  const Document scene = with_defaults(own);
  if (has_bonded(scene)) return Outcome::none("a bonded wheel's spring is no key");
  const Trace trace = trace_of(scene);
  const Transformed other = rescaled(scene, units);
  try {
    return compared(scene, trace, other.scene, other.image, rounding_of(scene));
  } catch (const InputError& refusal) {
    return Outcome::none(refusal.what());
  }
}

}  // namespace

Outcome mirror(const Document& scene, std::uint64_t) {
  if (scene.contains("system") && scene["system"]["planar"] == true)
    return Outcome::none("a plane is its own image");
  return reflected_alike(scene, 1);
}

Outcome reversal(const Document& scene, std::uint64_t) {
  if (is_endless(scene)) return Outcome::none("traffic without end runs ahead");
  return reflected_alike(scene, 0);
}

Outcome mass_scale(const Document& scene, std::uint64_t) {
  return rescaled_alike(scene, {.mass = 4.});
}

Outcome all_scales(const Document& scene, std::uint64_t) {
  if (scene.contains("irregularity")) return Outcome::none("spectra are in metres");
  if (has_one_sided(scene)) return Outcome::none("a damper sets in over a micrometre");
  if (has_fixed_lengths(scene)) return Outcome::none("a length of it is no key");
  const bool own_gravity = !scene.contains("track");
  if (!is_track_alone(scene) && scene["step"]["start"] == "equilibrium")
    return Outcome::none(kManyRests);
  return rescaled_alike(scene, own_gravity ? Units{2., .5, 8.} : Units{1.5625, 1.25, 2.});
}

namespace {

/// The track with more bays and other ends, without parts that belong to a place.
Document longer(const Document& scene, int bays, const char* end) {
  Document other = scene;
  other["track"]["bays"] = static_cast<int>(number(scene["track"], "bays")) + bays;
  other["track"]["ends"] = end;
  other["track"].erase("end_zone_bays");
  for (const char* key : {"support_change", "rail_joint", "stop", "irregularity", "output"})
    other.erase(key);
  return other;
}

/// The ends have an effect, which is estimated by the change that other ends make.
Outcome moved_between_ends(const Document& own) {
  constexpr int kMore = 16, kBays = 3;
  constexpr double kFelt = 1e-2;
  const Document scene = moved_on(longer(own, kMore, "free"), kMore / 2 - 1).scene;
  const Trace trace = trace_of(scene);
  const Transformed other = moved_on(scene, kBays);
  Document held = scene, other_held = other.scene;
  held["track"]["ends"] = other_held["track"]["ends"] = "clamped";
  const double ends = apart(trace, trace_of(held)).largest +
                      apart(trace_of(other.scene), trace_of(other_held)).largest;
  if (ends > kFelt) return Outcome::none("the ends are felt");
  return compared(scene, trace, other.scene, other.image, rounding_of(scene) + 4. * ends);
}

}  // namespace

Outcome translation(const Document& scene, std::uint64_t) {
  if (!scene.contains("track")) {
    if (scene["step"]["start"] == "equilibrium") return Outcome::none(kManyRests);
    constexpr double kBy[3] = {2., -1., .5};
    const double in_plane[3] = {kBy[0], scene["system"]["planar"] == true ? 0. : kBy[1], kBy[2]};
    const Transformed other = moved_off(scene, in_plane);
    return compared(scene, trace_of(scene), other.scene, other.image, rounding_of(scene));
  }
  if (!is_track_alone(scene)) return Outcome::none("joints to the ground stay where they are");
  if (!is_endless(scene)) return moved_between_ends(scene);
  if (!is_condensed(scene)) return Outcome::none("a window feels its ends");
  Document even = scene;
  even.erase("irregularity");
  even.erase("sensor");
  even["track"]["bays"] = static_cast<int>(number(even["track"], "bays")) + 2;
  const Transformed other = moved_on(even, 1);
  return compared(even, trace_of(even), other.scene, other.image, rounding_of(scene));
}

Outcome superposition(const Document& own, std::uint64_t) {
  if (!is_track_alone(own)) return Outcome::none("bodies turn");
  Document scene = own;
  for (const char* key : {"wheelset", "vehicle", "irregularity", "defect"}) scene.erase(key);
  scene["track"].erase("gravity");
  if (has_one_sided(scene)) return Outcome::none("what does not pull does not add up");
  scene["sensor"].erase(std::remove_if(scene["sensor"].begin(), scene["sensor"].end(),
                                       [](const Document& s) {
                                         return s["on"] == "wheelset" || s["on"] == "vehicle";
                                       }),
                        scene["sensor"].end());
  if (tables(scene, "load").size() < 2) return Outcome::none("one load");
  Document first = scene, second = scene;
  for (std::size_t i = 0; i < scene["load"].size(); ++i)
    for (const char* key : {"force_z_n", "amplitude_n"})
      if (scene["load"][i].contains(key)) (i == 0 ? second : first)["load"][i][key] = 0.;
  const Trace both = trace_of(scene), a = trace_of(first), b = trace_of(second);
  Trace sum = a;
  for (std::size_t i = 0; i < sum.rows.size(); ++i) {
    const std::size_t c = i % sum.columns.size();
    if (c > 0 && !quantity_of(sum.columns, c).place) sum.rows[i] += b.rows[i];
  }
  const Distance distance = apart(both, sum, [&](const std::string& column) {
    const auto at = std::find(both.columns.begin(), both.columns.end(), column);
    const auto c = static_cast<std::size_t>(at - both.columns.begin());
    return quantity_of(both.columns, c).place ? Image{} : Image{column};
  });
  const double bound = rounding_of(scene);
  return Outcome::of(distance.largest <= bound,
                     fmt::format("{}; allowed {:.2g}", distance.text(), bound));
}

}  // namespace railstep::property
