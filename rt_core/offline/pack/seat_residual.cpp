#include "offline/pack/seat_residual.h"

namespace railstep {

namespace {

constexpr int kPoints = 16;  // intervals of an element

}  // namespace

std::vector<double> seat_residual(const ResidualFlexibility& residual, const Model& model,
                                  const std::vector<LoadPoint>& wheel) {
  std::vector<double> all;
  for (std::int32_t r = 0; r < model.runners; ++r)
    for (const int side : {0, 1}) {
      const RunnerModel& runner = model.runner[r];
      const Cant& cant = model.cant[side];
      const SectionPoint centre = crown_centre(model, runner.contact, side);
      // The displacements along y of the railhead and of the axis make up the rows along y and of
      // the roll.
      const LoadPoint head{side, model.head_z[side], 0., 1}, axis{side, 0., 0., 1},
          pressed = wheel[static_cast<std::size_t>(runner.load_point[side])];
      const std::vector<double> hh = residual.under(head), ha = residual.under(head, axis),
                                aa = residual.under(axis), ph = residual.under(pressed, head),
                                pa = residual.under(pressed, axis);
      const double per_metre = 1. / (head.z * cant.cosine),
                   h = (cant.cosine * centre.z + cant.sine * centre.y) * per_metre, a = 1. - h;
      // The row along z is that of the crown's centre, beside the point that is pressed.
      const double beside = side_of_crown(runner.contact, side);
      for (std::size_t i = 0; i < hh.size(); ++i) {
        const double yy = h * h * hh[i] + 2. * h * a * ha[i] + a * a * aa[i],
                     yr = per_metre * (a * aa[i] + (h - a) * ha[i] - h * hh[i]),
                     pr = per_metre * (pa[i] - ph[i]),
                     rr = per_metre * per_metre * (hh[i] - 2. * ha[i] + aa[i]);
        const double seat[kSeatResiduals] = {yy,
                                             h * ph[i] + a * pa[i] + beside * yr,
                                             yr,
                                             beside * (2. * pr + beside * rr),
                                             pr + beside * rr,
                                             rr};
        all.insert(all.end(), seat, seat + kSeatResiduals);
      }
    }
  return all;
}

MeshResidual::MeshResidual(const PackedModel& packed, const Track& track,
                           const std::vector<Line>& lines)
    : model_(packed.model()) {
  const ResidualFlexibility residual(track, lines, {}, kPoints, true);
  for (const LoadPoint& point : packed.load_points()) {
    const std::vector<double> own = residual.under(point);
    under_.insert(under_.end(), own.begin(), own.end());
  }
  seats_ = seat_residual(residual, model_, packed.load_points());
  model_.residual = {};
  model_.residual.points = kPoints;
  model_.residual.elements = tabled_elements(track);
  model_.residual.under = under_.data();
  model_.residual.seat = seats_.data();
}

}  // namespace railstep
