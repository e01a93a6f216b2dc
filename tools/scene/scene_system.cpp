#include "scene/scene_system.h"

#include <fmt/core.h>

#include <limits>

#include "scene/scene_read.h"
#include "scene/scene_system_read.h"
#include "scene/scene_vector.h"

namespace railstep {
namespace {

constexpr const char* kSystemKeys[] = {"body",  "beam",   "joint", "spring",
                                       "force", "system", "joints"};

/// Refuses tables that belong to a track.
void refuse_track_keys(const Table& root) {
  for (const char* key : {"rail", "support", "sleeper", "ballast", "under_sleeper_pad", "load",
                          "wheelset", "vehicle", "condense", "static", "output"})
    if (root.has(key))
      root.refuse(
          key, "E-BODY-26",
          fmt::format("[{}] belongs to a track, but the scene has none; expected a scene of "
                      "bodies and beams without it",
                      key));
}

void read_whole(const Table& root, System& system) {
  const std::optional<Table> t = root.table_if("system");
  if (!t) return;
  system.planar = t->boolean("planar", false);
  system.gravity =
      read_in_plane(*t, "gravity_m_per_s2", between(-1e4, 1e4), system.planar, system.gravity);
}

StepScene read_system_step(const Table& t) {
  StepScene s = read_times(t);
  s.start =
      t.choice("start", {"equilibrium", "released"}, 1) == 0 ? Start::equilibrium : Start::released;
  read_scheme(t, 0.9, true, s);
  check_frames(t, s);
  return s;
}

/// Refuses a key beside other choices than its own, where it would have no effect.
void belongs(const Table& t, const char* key, bool in_use, const char* choice) {
  if (t.has(key) && !in_use)
    t.refuse(key, "E-BODY-27",
             fmt::format("{} has no effect here; expected {} beside it", key, choice));
}

SystemOptions read_hold(const Table& root) {
  constexpr ConstraintMethod kConstraintMethods[] = {
      ConstraintMethod::augmented_lagrangian, ConstraintMethod::baumgarte,
      ConstraintMethod::gear_gupta_leimkuhler, ConstraintMethod::direct};
  constexpr Renew kTangents[] = {Renew::every_iteration, Renew::every_step, Renew::kept};
  SystemOptions o{};
  const std::optional<Table> t = root.table_if("joints");
  if (!t) return o;
  o.constraint_method = kConstraintMethods[t->choice(
      "hold", {"augmented-lagrangian", "baumgarte", "gear-gupta-leimkuhler", "direct"}, 0)];
  o.cap = static_cast<int>(t->integer("cap", 1, 1000, o.cap));
  o.projections = static_cast<int>(t->integer("projections", 0, 100, o.projections));
  o.joint_tolerance = t->number("tolerance_m", between(1e-15, 1e-2), o.joint_tolerance);
  o.tolerance = t->number("force_tolerance", between(1e-14, 1e-2), o.tolerance);
  belongs(*t, "penalty", o.constraint_method == ConstraintMethod::augmented_lagrangian,
          "hold = \"augmented-lagrangian\"");
  o.penalty = t->number("penalty", between(1.0, 1e15), o.penalty);
  for (const char* key : {"alpha_per_s", "beta_per_s"})
    belongs(*t, key, o.constraint_method == ConstraintMethod::baumgarte, "hold = \"baumgarte\"");
  o.alpha = t->number("alpha_per_s", above_upto(0.0, 1e6), o.alpha);
  o.beta = t->number("beta_per_s", above_upto(0.0, 1e6), o.beta);
  if (t->has("tangent")) o.renew = kTangents[t->choice("tangent", {"iteration", "step", "kept"})];
  belongs(*t, "kept_steps", o.renew == Renew::kept, "tangent = \"kept\"");
  o.keep_steps = static_cast<int>(t->integer("kept_steps", 1, 100'000, o.keep_steps));
  return o;
}

void check_count(const Table& root, const System& system) {
  const std::size_t parts = system.bodies.size() + system.beams.size();
  if (parts == 0)
    root.refuse("", "E-BODY-28",
                "there is neither a [[body]] nor a [[beam]]; expected at least one of "
                "them");
  if (parts > kMaxSystemParts)
    root.refuse(
        system.beams.empty() ? "body" : "beam", "E-BODY-29",
        fmt::format("there are {} bodies and beams; expected at most {}", parts, kMaxSystemParts));
}

/// The system's inputs follow those of its track.
void drop_inputs_of_track(SystemScene& scene) {
  if (!scene.track) return;
  const auto count = static_cast<std::ptrdiff_t>(scene.track->inputs.size());
  scene.inputs.erase(scene.inputs.begin(), scene.inputs.begin() + count);
  for (SystemForce& force : scene.system.forces)
    if (force.input >= 0) force.input -= static_cast<int>(count);
}

SystemScene read_system_scene(const Table& root) {
  SystemScene scene;
  NameBook names;
  Intact intact;
  scene.file = root.file();
  scene.sum = root.sum();
  if (!root.has("track")) refuse_track_keys(root);
  const bool known = root.attempt({"system"}, [&] { read_whole(root, scene.system); });
  root.attempt({"joints"}, [&] { scene.options = read_hold(root); });
  if (root.has("track")) {
    scene.track = read_track_beside(root, scene, names, intact);
    if (scene.track->step) scene.step = *scene.track->step;
    scene.inputs = scene.track->inputs;  // read_forces() counts on from these
  } else {
    root.attempt_alone({"step"}, [&] { scene.step = read_system_step(root.table("step")); });
  }
  if (!known) root.end_part();  // [system] says whether all lies in a plane
  const bool bodies = read_bodies(root, scene, names), beams = read_beams(root, scene, names);
  // Joints, springs, forces and sensors name parts and points of them.
  if (!bodies || !beams || !intact.sections || !intact.spacing) root.end_part();
  check_count(root, scene.system);
  read_joints(root, scene, names);
  read_springs(root, scene, names);
  read_forces(root, scene);
  drop_inputs_of_track(scene);
  root.attempt(
      {"sensor"}, [&] { read_system_sensors(root, scene, names); }, intact.seats && intact.traffic);
  return scene;
}

}  // namespace

const char* key_of_system(const Table& root) {
  for (const char* key : kSystemKeys)
    if (root.has(key)) return key;
  return nullptr;
}

AnyScene read_any_scene(const std::filesystem::path& file,
                        const std::vector<std::string>& overrides) {
  const Table root = open_scene(file, overrides);
  if (key_of_system(root)) return root.whole(read_system_scene, kSceneKeys);
  return root.whole(read_track_scene, kSceneKeys);
}

}  // namespace railstep
