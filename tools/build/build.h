#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "build/trace_names.h"
#include "offline/math/constants.h"
#include "offline/pack/artefact.h"
#include "offline/pack/pack.h"
#include "scene/scene.h"
#include "text/read.h"

namespace railstep {

/// A rail's section. Where the scene gives its shape: its moments up to degree 4 about the
/// centroid, as the scene's rule integrates them.
struct RailSection {
  Section section;
  std::optional<SectionMoments> moments;
};

/// Section of a bar. Throws InputError that begins with `place`, "FILE: [table]"; also where
/// `nonlinear` or the bar's rule needs moments that the section does not have.
RailSection bar_section(const BarScene& bar, bool nonlinear, const std::string& place);

/// A section about its centroid, with its moments where it has them.
BeamSection beam_section(const RailSection& bar);

/// The section that a scene gives in one of the five ways. Shear factors given in [rail] replace
/// the section's. Those of rectangles are at the scene's Poisson ratio, those of a profile or a
/// section file at kFitPoisson. Throws InputError; also where the rail's model or rule needs
/// moments and the scene gives none. Throws Failed where no rectangles fit the profile.
RailSection rail_section_of(const Scene& scene, int rail = kLeftRail);

/// Height of a place on the section over the reference line, m.
/// @param axis_z  height of that line above the centroid, m
double height_z(Height at, const Section& section, double axis_z = 0.);

Section section_of(const Scene& scene);

/// Sections of left and right rail; each is found once.
using RailSections = std::array<Section, 2>;
RailSections sections_of(const Scene& scene);
inline const Section& section_of(const RailSections& sections, int rail) {
  return sections[static_cast<std::size_t>(rail)];
}

/// The head that wheels meet on a rail.
Railhead railhead_of(const Scene& scene, const RailSections& sections, int rail);
/// Height of a rail's axis over the left one's, m: railheads are level.
double rail_z(const Scene& scene, const RailSections& sections, const Track& track, int rail);

/// Height of a reference line above the centroid, m.
double axis_z_of(ReferenceLine line, const Section& section);

/// The track of a scene. Throws InputError; also for rails that buckle under their compression.
Track track_of(const Scene& scene);
Track track_of(const Scene& scene, const RailSection& rail);

/// Makes a scene's changes to the seats of its track.
void change_seats(const std::vector<SeatChange>& changes, Track& track);

/// The factor of a change's scatter on one side of one seat: even between 1 - width and 1 + width,
/// the same on every machine, by random.h's uniform() over seed, stream and side, and seat.
double scatter_factor(std::uint64_t seed, std::uint64_t stream, int seat, std::size_t side,
                      double width);

/// The traffic on a track with its sensors, and the names of the trace's columns.
struct TracedTraffic {
  Traffic traffic;
  TraceNames names;
};
TracedTraffic traffic_of(const Scene& scene, const Track& track);
/// Names of the inputs of a track: of forces, then of external wheels.
std::vector<std::string> input_names(const Scene& scene);
/// Throws InputError.
PackOptions pack_options_of(const Scene& scene);

/// How a scene's lines are condensed and how much they keep. A scene of full order gets the
/// reduction of kind = "modal".
Reduction reduction_of(const Scene& scene);

/// A scene's model, and the columns of its trace. Throws InputError where no model can be made (for
/// example with a free rigid mode) and for scenes that `railstep run` does not step.
struct Built {
  explicit Built(const Scene& scene);
  Track track;
  std::vector<std::string> columns;
  std::vector<std::string> inputs;  // NAME.force_n of each
  std::string about;                // about.h
  std::unique_ptr<PackedModel> packed;
};

/// A block's text: columns of a trace, an empty line, then inputs.
std::string block_text(const std::vector<std::string>& columns,
                       const std::vector<std::string>& inputs);

/// The model with its columns and inputs in one block. @param notes  about is the scene's
std::vector<std::byte> block_of(const Built& built, BlockNotes notes = {});

}  // namespace railstep
