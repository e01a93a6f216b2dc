#include "suite.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "generators.h"

namespace railstep::property {

const std::vector<Generator>& all_generators() {
  static const std::vector<Generator> all = {{"track", random_track_scene},
                                             {"mechanism", random_mechanism_scene},
                                             {"endless", random_endless_scene}};
  return all;
}

const std::vector<Property>& all_properties() {
  static const std::vector<Property> all = {
      {"mirror", "left and right may be swapped", mirror},
      {"reversal", "the track may be run over the other way", reversal},
      {"mass_scale", "masses, stiffnesses and forces times 4 move nothing", mass_scale},
      {"all_scales", "metres, seconds and kilograms may be others", all_scales},
      {"translation", "a bay is as the next one, and a place as another", translation},
      {"superposition", "two loads do what each does", superposition},
      {"rest", "what stands in equilibrium stands", rest},
      {"model_file", "a model file has the bits of its scene", model_file},
      {"snapshot", "a snapshot goes on with the same bits", snapshot},
      {"frames", "frames are of any number of steps", frames},
      {"statics", "static deflections do not depend on mesh or condensation", statics},
      {"stated_error", "condense states its errors", stated_error},
      {"energy", "energy is accounted for", energy},
      {"status", "ordinary scenes have no status bits", status},
      {"provoked", "what a scene provokes is told of", provoked}};
  return all;
}

Result result_of(const Property& property, const Document& scene, std::uint64_t seed) {
  try {
    const Outcome outcome = property.check(scene, seed);
    switch (outcome.kind) {
      case Outcome::Kind::holds:
        return {Result::Kind::holds, outcome.figures};
      case Outcome::Kind::fails:
        return {Result::Kind::fails, outcome.figures};
      case Outcome::Kind::does_not_apply:
        return {Result::Kind::does_not_apply, outcome.figures};
    }
  } catch (const InputError& refusal) {
    return {Result::Kind::refused, refusal.what()};
  } catch (const nlohmann::json::exception& error) {  // the scene was made too small
    return {Result::Kind::refused, error.what()};
  } catch (const std::exception& error) {
    return {Result::Kind::fails, std::string("threw: ") + error.what()};
  }
  return {};
}

namespace {

/// Adds all scenes with one thing less than this one: a table, an entry of an array, a key.
void collect_without(const Document& whole, const Document::json_pointer& at, int depth,
                     std::vector<Document>& simpler) {
  const Document& here = whole[at];
  const auto add = [&](const auto& which) {
    Document other = whole;
    other[at].erase(which);
    if (other[at].empty() && !at.empty()) other[at.parent_pointer()].erase(at.back());
    simpler.push_back(std::move(other));
  };
  if (here.is_object())
    for (const auto& entry : here.items()) add(entry.key());
  else if (here.is_array() && !here.empty() && here[0].is_object())
    for (std::size_t i = 0; i < here.size(); ++i) add(i);
  if (depth == 0) return;
  if (here.is_object())
    for (const auto& entry : here.items())
      if (entry.value().is_structured())
        collect_without(whole, at / entry.key(), depth - 1, simpler);
  if (here.is_array())
    for (std::size_t i = 0; i < here.size(); ++i)
      if (here[i].is_object()) collect_without(whole, at / i, depth - 1, simpler);
}

/// Adds scenes with half the frames, or with fewer elements, rails or unknowns.
void collect_smaller(const Document& scene, std::vector<Document>& simpler) {
  const auto with = [&](const char* table, const char* key, const Document& value) {
    if (!scene.contains(table) || scene[table].value(key, Document()) == value) return;
    simpler.push_back(scene);
    simpler.back()[table][key] = value;
  };
  const double dt = number(scene["step"], "dt_s");
  const double frame = number(scene["step"], "frame_s", dt);
  const double frames = std::round(number(scene["step"], "duration_s") / frame);
  if (frames >= 2.) with("step", "duration_s", std::floor(.5 * frames) * frame);
  with("track", "elements_per_bay", 1);
  with("track", "unknowns", "vertical");
  with("track", "rails", 1);
  with("track", "ends", "free");
}

}  // namespace

Document shrunk(const Property& property, Document scene, std::uint64_t seed) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + std::chrono::seconds(kShrinkSeconds);
  const bool threw = result_of(property, scene, seed).figures.starts_with("threw");
  for (bool again = true; again;) {
    again = false;
    std::vector<Document> simpler;
    collect_smaller(scene, simpler);
    collect_without(scene, Document::json_pointer(), 3, simpler);
    for (Document& other : simpler) {
      if (Clock::now() > end) return scene;
      const Result result = result_of(property, other, seed);
      if (result.kind != Result::Kind::fails || result.figures.starts_with("threw") != threw)
        continue;
      scene = std::move(other);
      again = true;
      break;
    }
  }
  return scene;
}

}  // namespace railstep::property
