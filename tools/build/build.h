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

/// A rail's section, and its moments to degree 4 about the centroid as the scene's rule integrates
/// them, where the scene gives its shape.
struct RailSection {
  Section section;
  std::optional<SectionMoments> moments;
};

/// Section of a bar. Throws InputError at `place`, "FILE: [table]", and where `nonlinear` (or the
/// bar's rule) wants moments that it does not have.
RailSection bar_section(const BarScene& bar, bool nonlinear, const std::string& place);

/// A section about its centroid, with its moments where there are any.
BeamSection beam_section(const RailSection& bar);

/// The section that a scene names, whichever way it does; shear factors given in [rail] replace the
/// section's. Those of rectangles are at the scene's Poisson ratio, those of a profile or a section
/// file at kFitPoisson. Throws InputError, std::runtime_error where no rectangles fit the profile.
/// Throws InputError too where the rail's model or rule wants moments and the scene gives none.
RailSection rail_section_of(const Scene& scene, int rail = kLeftRail);

/// Height over the reference line, m, of a place on the section.
/// @param axis_z  of that line above the centroid, m
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

/// The track of a scene. Throws InputError, for rails under so much compression that they buckle
/// too.
Track track_of(const Scene& scene);
Track track_of(const Scene& scene, const RailSection& rail);

/// Makes a scene's changes to the seats of its track.
void change_seats(const std::vector<SeatChange>& changes, Track& track);

/// The factor of a change's scatter on one side of one seat: even between 1 - width and 1 + width,
/// the same on every machine, by random.h's uniform() over seed, stream and side, and seat.
double scatter_factor(std::uint64_t seed, std::uint64_t stream, int seat, std::size_t side,
                      double width);

/// What acts on a track, what is read from it, and what a trace's columns are named after.
struct TracedTraffic {
  Traffic traffic;
  TraceNames names;
};
TracedTraffic traffic_of(const Scene& scene, const Track& track);
/// Throws InputError.
PackOptions pack_options_of(const Scene& scene);

/// How a scene's lines are condensed and how much they keep; of a scene of full order what
/// kind = "modal" would.
Reduction reduction_of(const Scene& scene);

/// A scene's model, and the columns of its trace. Throws InputError, in one sentence, for what
/// makes no model (a free rigid mode, say) and for what `railstep run` does not step.
struct Built {
  explicit Built(const Scene& scene);
  Track track;
  std::vector<std::string> columns;
  std::vector<std::string> inputs;  // NAME.force_n of each
  std::string about;                // about.h
  std::unique_ptr<PackedModel> packed;
};

/// A block's text: columns of a trace, then, behind an empty line, inputs.
std::string block_text(const std::vector<std::string>& columns,
                       const std::vector<std::string>& inputs);

/// The model with its columns and inputs in one block. @param notes  about is the scene's
std::vector<std::byte> block_of(const Built& built, BlockNotes notes = {});

}  // namespace railstep
