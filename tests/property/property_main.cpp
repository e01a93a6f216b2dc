// Checks any number of random scenes against laws: docs/properties.md.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "suite.h"

using namespace railstep::property;

namespace {

struct Options {
  std::uint64_t seed = 1;
  int count = 20;
  std::string generator, property, scene, found = ".";
  bool keep = false, print = false, quiet = false;
};

struct Tally {
  int holds = 0, fails = 0, does_not_apply = 0, refused = 0;
  double seconds = 0.;
  std::map<std::string, int> refusals;  // by the message behind the file's name
};

std::string sentence_of(const std::string& refusal) {
  const std::size_t at = refusal.find(".toml:");
  return at == std::string::npos ? refusal : refusal.substr(at + 6);
}

/// Prints a failure and writes its scene, shrunk unless options say to keep it.
void report(const Options& o, const std::string& generator, const Property& property,
            const Document& scene, std::uint64_t seed, const Result& result) {
  fmt::print("FAILS {} of {} {}: {}\n", property.name, generator, seed, result.figures);
  const Document small = o.keep ? scene : shrunk(property, scene, seed);
  const std::string file = fmt::format("{}/{}_{}_{}.toml", o.found, generator, seed, property.name);
  std::ofstream(file) << fmt::format("# {}: {}\n", property.name,
                                     result_of(property, small, seed).figures)
                      << text_of(small);
  fmt::print("      {} --scene {} --property {} --seed {}\n", "property", file, property.name,
             seed);
  std::fflush(stdout);
}

void check(const Options& o, const std::string& generator, const Document& scene,
           std::uint64_t seed, std::map<std::string, Tally>& tallies) {
  for (const Property& property : all_properties()) {
    if (!o.property.empty() && o.property != property.name) continue;
    Tally& tally = tallies[generator + " " + property.name];
    const auto start = std::chrono::steady_clock::now();
    const Result result = result_of(property, scene, seed);
    tally.seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    switch (result.kind) {
      case Result::Kind::holds:
        ++tally.holds;
        break;
      case Result::Kind::does_not_apply:
        ++tally.does_not_apply;
        break;
      case Result::Kind::refused:
        ++tally.refused;
        ++tally.refusals[sentence_of(result.figures)];
        break;
      case Result::Kind::fails:
        ++tally.fails;
        report(o, generator, property, scene, seed, result);
    }
    if (!o.scene.empty() && !o.quiet) fmt::print("{}: {}\n", property.name, result.figures);
  }
}

int print_tallies(const std::map<std::string, Tally>& tallies, bool quiet) {
  int fails = 0;
  fmt::print("{:<26}{:>7}{:>7}{:>9}{:>9}{:>9}\n", "", "holds", "fails", "apply not", "refused",
             "ms");
  std::map<std::string, int> refusals;
  for (const auto& [name, t] : tallies) {
    const int all = t.holds + t.fails + t.does_not_apply + t.refused;
    fmt::print("{:<26}{:>7}{:>7}{:>9}{:>9}{:>9.1f}\n", name, t.holds, t.fails, t.does_not_apply,
               t.refused, 1e3 * t.seconds / std::max(1, all));
    fails += t.fails;
    for (const auto& [sentence, times] : t.refusals) refusals[sentence] += times;
  }
  if (!quiet)
    for (const auto& [sentence, times] : refusals)
      fmt::print("refused {:>4}: {}\n", times, sentence);
  return fails;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CLI::App app("Random scenes against laws that every scene obeys");
  app.add_option("--seed", o.seed, "the first one");
  app.add_option("--count", o.count, "how many");
  app.add_option("--generator", o.generator, "track, mechanism or endless; all by default");
  app.add_option("--property", o.property, "one of them alone");
  app.add_option("--scene", o.scene, "a scene in the place of random ones");
  app.add_option("--found", o.found, "folder for scenes that fail");
  app.add_flag("--keep", o.keep, "write these as they are, not made smaller");
  app.add_flag("--print", o.print, "print the scene of --seed and --generator, and check nothing");
  app.add_flag("--quiet", o.quiet, "no list of refusals");
  CLI11_PARSE(app, argc, argv);
  std::map<std::string, Tally> tallies;
  if (!o.scene.empty()) check(o, "scene", document_of(o.scene), o.seed, tallies);
  for (const Generator& generator : all_generators()) {
    if (!o.scene.empty() || (!o.generator.empty() && o.generator != generator.name)) continue;
    for (std::uint64_t seed = o.seed; seed < o.seed + static_cast<std::uint64_t>(o.count); ++seed) {
      const Document scene = generator.scene(seed);
      if (o.print)
        fmt::print("{}", text_of(scene));
      else
        check(o, generator.name, scene, seed, tallies);
    }
  }
  return o.print || print_tallies(tallies, o.quiet) == 0 ? 0 : 1;
}
