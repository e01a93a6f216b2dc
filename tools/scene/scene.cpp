#include "scene/scene.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "scene/scene_read.h"

namespace railstep {
namespace {

/// One word for both ends, or a pair [x = 0, x = length].
RailEnds read_ends(const Table& t) {
  constexpr RailEnd kEnds[] = {RailEnd::free, RailEnd::pinned, RailEnd::clamped,
                               RailEnd::non_reflecting};
  const auto ends = t.choices("ends", {"free", "pinned", "clamped", "non-reflecting"}, 2, 0);
  return {kEnds[ends[0]], kEnds[ends[1]]};
}

/// Bays of the zone before a non-reflecting end. The zones of both ends must lie on the track.
int read_end_zone(const Table& t, const TrackScene& track) {
  const std::int64_t zones =
      std::count(track.ends.begin(), track.ends.end(), RailEnd::non_reflecting);
  if (zones == 0) {
    if (t.has("end_zone_bays"))
      t.refuse("end_zone_bays", "E-SCENE-03",
               "end_zone_bays is given, but no end is \"non-reflecting\"; expected ends "
               "= \"non-reflecting\", or no end_zone_bays");
    return kEndZoneBays;
  }
  const auto bays = static_cast<int>(t.integer("end_zone_bays", 1, 10'000, kEndZoneBays));
  if (zones * bays > track.bays)
    t.refuse("end_zone_bays", "E-SCENE-04",
             fmt::format("end_zone_bays = {} at {} non-reflecting end{} does not fit on bays = "
                         "{}; expected end_zone_bays = {} or less, or more bays",
                         bays, zones, zones > 1 ? "s" : "", track.bays, track.bays / zones));
  return bays;
}

/// A track without end is linearised at rest and has no ends.
void check_endless(const Table& t, const TrackScene& track) {
  if (track.ends != RailEnds{})
    t.refuse("ends", "E-SCENE-05",
             "a track without end has no ends to hold; expected ends = \"free\"");
  if (track.model != RailModel::linearised)
    t.refuse("model", "E-SCENE-06",
             "length = \"endless\" needs a linearised rail; expected model = "
             "\"linearised\"");
  if (track.linearised_under_weight)
    t.refuse("linearised_at", "E-SCENE-07",
             "length = \"endless\" needs a rail that is linearised at rest; expected "
             "linearised_at = \"rest\"");
}

TrackScene read_track(const Table& t) {
  if (t.choice("form", {"flexible", "rigid"}, 0) == 1) return read_rigid_track(t);
  TrackScene track{};
  constexpr Unknowns kUnknowns[] = {Unknowns::full, Unknowns::rigid_section, Unknowns::vertical};
  track.unknowns = kUnknowns[t.choice("unknowns", {"full", "rigid-section", "vertical"})];
  track.rails = static_cast<int>(t.integer("rails", 1, 2, 2));
  track.bays = t.integer("bays", 1, std::int64_t{1} << 53);
  track.bay = t.number("bay_m", between(0.05, 5.0));
  track.elements_per_bay = static_cast<int>(t.integer("elements_per_bay", 1, 1000, 2));
  track.rail_spacing = t.number("rail_spacing_m", between(0.3, 3.0), 1.5);
  track.ends = read_ends(t);
  track.end_zone_bays = read_end_zone(t, track);
  if (t.has("length")) track.endless = t.choice("length", {"endless"}) == 0;
  track.gravity = t.boolean("gravity", false);
  constexpr RailModel kModels[] = {RailModel::linearised, RailModel::nonlinear,
                                   RailModel::timoshenko};
  track.model = kModels[t.choice("model", {"linearised", "nonlinear", "timoshenko"}, 0)];
  if (track.model == RailModel::nonlinear && track.unknowns != Unknowns::full)
    t.refuse("model", "E-SCENE-08",
             "model = \"nonlinear\" bends in space, where a rail shortens; expected "
             "unknowns = \"full\"");
  track.linearised_under_weight = t.choice("linearised_at", {"rest", "weight"}, 0) == 1;
  if (track.linearised_under_weight && track.unknowns != Unknowns::full)
    t.refuse("linearised_at", "E-SCENE-09",
             "linearised_at = \"weight\" couples sag and stretch; expected unknowns = "
             "\"full\"");
  track.reference_line = read_reference_line(t);
  if (track.reference_line != ReferenceLine::centroid && track.unknowns != Unknowns::full)
    t.refuse("reference_line", "E-SCENE-10",
             "nodes off the centroid move along x as the rail bends; expected "
             "reference_line = \"centroid\", or unknowns = \"full\"");
  if (track.endless) check_endless(t, track);
  return track;
}

/// Refuses a track that is too large for any machine before it takes memory. The bytes are those of
/// four banded matrices of doubles (M, C, K and the factored step matrix).
void check_size(const Table& t, const TrackScene& track) {
  const double elements = static_cast<double>(track.rails) * static_cast<double>(track.bays) *
                          static_cast<double>(track.elements_per_bay);
  if (elements <= static_cast<double>(kMostElements)) return;
  constexpr double kPerNode[] = {9.0, 6.0, 2.0};  // full, rigid section, vertical
  const double per_node = kPerNode[static_cast<int>(track.unknowns)];
  const double unknowns = elements * 2.0 * per_node;  // two nodes an element
  const double bandwidth = 6.0 * per_node;
  t.refuse("bays", "E-SCENE-11",
           fmt::format("bays = {} makes {:.0f} elements, about {:.3g} bytes; expected at most "
                       "{} elements",
                       track.bays, elements, 4.0 * 8.0 * unknowns * bandwidth, kMostElements));
}

/// Spring and damper along one axis.
void read_spring(const Table& t, std::size_t axis, bool required, std::array<double, 3>& stiffness,
                 std::array<double, 3>& damping) {
  const std::string key = fmt::format("stiffness_{}_n_per_m", "xyz"[axis]);
  const Range accepted = between(0.0, 1e13);
  stiffness[axis] = required ? t.number(key, accepted) : t.number(key, accepted, 0.0);
  damping[axis] =
      t.number(fmt::format("damping_{}_n_s_per_m", "xyz"[axis]), between(0.0, 1e11), 0.0);
}

/// Heat presses only a rail that cannot grow.
void check_held(const Table& rail, const Scene& scene) {
  const auto& ends = scene.track.ends;
  if (scene.rail.temperature_rise != 0.0 && (ends[0] == RailEnd::free || ends[1] == RailEnd::free))
    rail.refuse("temperature_rise_k", "E-RAIL-08",
                fmt::format("temperature_rise_k = {:.15g}, but a free end lets the rail grow; "
                            "expected 0, or track.ends that are pinned, clamped or non-reflecting",
                            scene.rail.temperature_rise));
}

/// Reads gauge_m, which replaces rail_spacing_m.
void read_gauge(const Table& track, Scene& scene) {
  if (!track.has("gauge_m")) return;
  const double gauge = track.number("gauge_m", between(0.3, 3.0));
  if (track.has("rail_spacing_m"))
    track.refuse("gauge_m", "E-RAIL-09",
                 "gauge_m is given beside rail_spacing_m; expected one of them");
  if (scene.track.rails == 1)
    track.refuse("gauge_m", "E-RAIL-10",
                 "gauge_m is given, but the track has one rail; expected rails = 2");
  if (scene.rail.cant != 0.0)
    track.refuse("gauge_m", "E-RAIL-11",
                 "gauge_m is measured between the heads of upright rails, but rail.cant "
                 "is not 0; expected rail_spacing_m, the distance between the rails' axes");
  scene.track.rail_spacing = spacing_of_gauge(track, scene, gauge);
}

/// A leaning rail moves sideways too under a vertical force.
void check_cant(const Table& rail, const Scene& scene) {
  if (scene.rail.cant != 0.0 && scene.track.unknowns == Unknowns::vertical)
    rail.refuse("cant", "E-RAIL-12",
                "cant makes a vertical force move the rail sideways too; expected "
                "track.unknowns = \"rigid-section\" or \"full\"");
}

std::optional<SupportScene> read_support(const Table& root, const Scene& scene) {
  const std::optional<Table> given = root.table_if("support");
  if (!given) return std::nullopt;
  const Table& t = *given;
  SupportScene s{};
  for (const std::size_t axis : {0u, 1u, 2u})
    read_spring(t, axis, axis == 2, s.stiffness, s.damping);
  s.roll_stiffness = t.number("stiffness_roll_n_m_per_rad", between(0.0, 1e13), 0.0);
  s.roll_damping = t.number("damping_roll_n_m_s_per_rad", between(0.0, 1e11), 0.0);
  s.at = t.choice("at", {"foot", "axis"}, 0) == 0 ? Height::foot : Height::axis;
  s.half_spread = t.number("half_spread_m", between(0.0, 0.5), 0.0);
  s.length = t.number("length_m", between(0.0, scene.track.bay), 0.0);
  s.unilateral = t.boolean("unilateral", false);
  s.gap = t.number("gap_m", between(0.0, 0.1), 0.0);
  return s;
}

std::optional<Sleeper> read_sleeper(const Table& root, const Scene& scene) {
  const std::optional<Table> t = root.table_if("sleeper");
  const std::optional<Table> ballast = root.table_if("ballast"),
                             under_pad = root.table_if("under_sleeper_pad");
  if (!t && under_pad)
    under_pad->refuse("", "E-SUPPORT-02",
                      "there is [under_sleeper_pad] but no [sleeper] on it; expected [sleeper] and "
                      "[ballast], or none of the three");
  if (!t && !ballast) return std::nullopt;
  if (!ballast)
    t->refuse("", "E-SUPPORT-01",
              "there is a [sleeper] but no [ballast] under it; expected both tables or "
              "neither");
  if (!t)
    ballast->refuse("", "E-SUPPORT-02",
                    "there is [ballast] but no [sleeper] on it; expected both tables or "
                    "neither");
  if (!scene.support)
    t->refuse("", "E-SUPPORT-03",
              "there is a [sleeper] but no [support] on it; expected a [support]");
  Sleeper s;
  s.mass = t->number("mass_kg", between(0.0, 1e5));  // 0: pad and ballast in series
  s.roll_inertia = scene.track.rails == 2 ? t->number("roll_inertia_kg_m2", between(0.0, 1e6))
                                          : t->number("roll_inertia_kg_m2", between(0.0, 1e6), 0.0);
  read_spring(*ballast, 2, true, s.ballast_stiffness, s.ballast_damping);
  s.pitch_inertia = t->number("pitch_inertia_kg_m2", between(0.0, 1e6), 0.0);
  s.ballast_length = ballast->number("length_m", between(0.0, 5.0), 0.0);
  s.ballast_unilateral = ballast->boolean("unilateral", false);
  s.ballast_gap = ballast->number("gap_m", between(0.0, 0.1), 0.0);
  if (under_pad)
    s.under_pad = {under_pad->number("stiffness_z_n_per_m", above_upto(0.0, 1e13)),
                   under_pad->number("damping_z_n_s_per_m", between(0.0, 1e11), 0.0)};
  if (s.ballast_length > 0.0 && scene.support->length == 0.0)
    ballast->refuse("length_m", "E-SUPPORT-09",
                    "length_m makes the sleeper pitch, but pads that are points do not feel "
                    "it; expected support.length_m above 0");
  for (const std::size_t axis : {0u, 1u})
    if (ballast->has(fmt::format("stiffness_{}_n_per_m", "xyz"[axis])) ||
        ballast->has(fmt::format("damping_{}_n_s_per_m", "xyz"[axis]))) {
      read_spring(*ballast, axis, true, s.ballast_stiffness, s.ballast_damping);
      if (s.ballast_stiffness[axis] == 0.0)
        ballast->refuse(
            fmt::format("stiffness_{}_n_per_m", "xyz"[axis]), "E-SUPPORT-19",
            fmt::format("stiffness_{0}_n_per_m = 0 leaves the sleeper free along {0}; expected a "
                        "stiffness above 0, or neither stiffness nor damping along {0}, which "
                        "holds the sleeper there",
                        "xyz"[axis]));
    }
  return s;
}

NewtonOptions read_statics(const Table& root) {
  NewtonOptions s;
  const std::optional<Table> t = root.table_if("static");
  if (!t) return s;
  s.tolerance = t->number("tolerance", between(1e-14, 1e-2), s.tolerance);
  s.most_iterations = static_cast<int>(t->integer("most_iterations", 1, 1000, s.most_iterations));
  s.most_halvings = static_cast<int>(t->integer("most_load_halvings", 0, 30, s.most_halvings));
  return s;
}

}  // namespace

ReferenceLine read_reference_line(const Table& t) {
  constexpr ReferenceLine kLines[] = {ReferenceLine::centroid, ReferenceLine::mid_height,
                                      ReferenceLine::foot, ReferenceLine::head};
  return kLines[t.choice("reference_line", {"centroid", "mid-height", "foot", "head"}, 0)];
}

Table open_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  Table root = read_toml(file, overrides);
  const std::int64_t schema = root.integer("schema", 1, std::numeric_limits<std::int64_t>::max());
  if (schema > 1)
    root.refuse("schema", "E-SCENE-27",
                fmt::format("schema = {} is newer than this program; expected 1", schema));
  return root;
}

namespace {

/// The rails' sections and all that is checked against them.
void read_sections(const Table& root, Scene& scene, Intact& intact) {
  const Table rail = root.table("rail");
  intact.sections = root.attempt({"rail"}, [&] {
    scene.rail = read_rail(rail);
    const std::optional<Table> right = rail.table_if("right");
    if (right && scene.track.rails == 1)
      right->refuse("", "E-SCENE-28",
                    "the track has one rail, the left one; expected track.rails = 2 beside "
                    "[rail.right]");
    if (right) scene.right_rail = read_right_rail(*right, scene.rail);
  });
  // The readers go on behind a bad value to find more of them, but not on rails without numbers.
  if (!intact.sections && root.is_tainted()) root.end_part();
  intact.spacing = root.attempt(
      {"track"}, [&] { read_gauge(root.table("track"), scene); }, intact.sections);
  root.attempt(
      {}, [&] { check_cant(rail, scene); }, intact.sections);
  root.attempt(
      {}, [&] { check_held(rail, scene); }, intact.sections);
  root.attempt(
      {"rail_joint"}, [&] { read_joints(root, rail, scene); }, intact.sections);
}

/// [support] and what stands under it.
void read_seats(const Table& root, Scene& scene, Intact& intact) {
  scene.support = read_support(root, scene);
  intact.seats = root.attempt({"sleeper", "ballast", "under_sleeper_pad"}, [&] {
    scene.sleeper = read_sleeper(root, scene);
  }) || root.is_tainted();
  root.attempt_alone(
      {"support_change"}, [&] { scene.seat_changes = read_seat_changes(root, scene); },
      intact.seats);
  if (scene.track.endless && scene.support && scene.support->length > 0.)
    root.attempt({}, [&] {
      root.table("support").refuse(
          "length_m", "E-SUPPORT-20",
          "the pads of a track without end are points; expected length_m = 0");
    });
  if (scene.track.endless && !scene.seat_changes.empty())
    root.attempt({}, [&] {
      root.table("track").refuse("length", "E-SUPPORT-21",
                                 "the seats of a track without end are alike; expected no "
                                 "[[support_change]]");
    });
}

/// Refuses columns for the supports of a track without end, where none has a fixed place.
void check_output(const Table& root, const Scene& scene) {
  if (scene.trace_supports && scene.track.endless)
    root.table("output").refuse(
        "supports", "E-SCENE-31",
        "the supports of a track without end pass under its traffic; expected "
        "[[sensor]] tables instead, as sensors follow the traffic bay by bay");
}

}  // namespace

Intact read_rails(const Table& root, Scene& scene) {
  Intact intact;
  scene.file = root.file();
  scene.sum = root.sum();
  const Table track = root.table("track");
  scene.track = read_track(track);
  if (scene.track.rigid) {
    scene.rail = read_rigid_rail(root);
    intact.spacing = root.attempt({"track"}, [&] { read_gauge(track, scene); });
    return intact;
  }
  const bool fits = root.attempt({}, [&] { check_size(track, scene.track); });
  if (!fits && !root.is_tainted()) root.end_part();              // all places lie on its length
  scene.track.bays = std::min(scene.track.bays, kMostElements);  // seats are counted below
  read_sections(root, scene, intact);
  read_seats(root, scene, intact);
  return intact;
}

void read_traffic(const Table& root, Scene& scene, Intact& intact) {
  intact.condensed =
      root.attempt({"condense"}, [&] { scene.condense = read_condense(root, scene.track); });
  if (scene.step) {
    root.attempt({}, [&] { check_moving(root, scene); });
    root.attempt(
        {}, [&] { check_contact(root, scene); }, intact.condensed);
  }
  root.attempt_alone({"stop"}, [&] { scene.stops = read_stops(root, scene); });
  root.attempt_alone({"load"}, [&] { scene.loads = read_loads(root, scene); });
  const bool wheelsets = root.attempt(
      {"wheelset"}, [&] { scene.wheelsets = read_wheelsets(root, scene, scene.inputs); },
      intact.sections);
  const bool vehicles = root.attempt(
      {"vehicle", "contact", "coupler"},
      [&] { scene.vehicles = read_vehicles(root, scene, scene.inputs, scene.rail_vehicles); },
      intact.sections);
  const bool external = root.attempt(
      {"external_wheel"}, [&] { scene.external_wheels = read_external_wheels(root, scene); });
  intact.traffic = (wheelsets && vehicles && external) || root.is_tainted();
  root.attempt_alone(
      {"line"}, [&] { scene.design_line = read_design_line(root, scene); }, intact.traffic);
  root.attempt_alone(
      {"irregularity"}, [&] { scene.irregularity = read_irregularity(root, scene); },
      intact.traffic);
  root.attempt_alone(
      {"defect"}, [&] { scene.defects = read_defects(root, scene); }, intact.traffic);
  const std::optional<Table> output = root.table_if("output");
  scene.trace_supports = output && output->boolean("supports", false);
}

Scene read_track_scene(const Table& root) {
  Scene scene;
  // No other table is needed to read the step, so that its errors stand beside all others.
  const bool is_stepped = root.attempt_alone({"step"}, [&] {
    if (const std::optional<Table> step = root.table_if("step"))
      scene.step = read_track_step(*step);
  });
  if (!is_stepped) scene.step.reset();
  Intact intact = read_rails(root, scene);
  scene.statics = read_statics(root);
  read_traffic(root, scene, intact);
  root.attempt_alone(
      {"sensor"}, [&] { scene.sensors = read_sensors(root, scene); },
      intact.seats && intact.traffic);
  root.attempt({}, [&] { check_output(root, scene); });
  NameBook names;
  claim_names(root, scene, names);
  return scene;
}

Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  const Table root = open_scene(file, overrides);
  if (const char* key = key_of_system(root))
    root.refuse(
        key, "E-SCENE-02",
        fmt::format("the key {} makes this a scene of bodies and beams, which only `run` and "
                    "`condense` take; expected a scene of a track alone",
                    key));
  return root.whole(read_track_scene, kSceneKeys);
}

}  // namespace railstep
