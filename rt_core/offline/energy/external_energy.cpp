#include "offline/energy/external_energy.h"

namespace railstep {
namespace {

double work(const Model& model, const std::vector<ExternalContact>& contacts,
            const Configuration& moved) {
  double sum = 0.;
  for (const ExternalContact& at : contacts)
    for (int d = 0; d < 3 && at.on_rail; ++d)
      for (std::int32_t l = 0; l < model.lines; ++l)
        sum += at.force[d] * motion(model.line[l], at.row[d], moved);
  return sum;
}

}  // namespace

std::vector<ExternalContact> external_in_step(const Model& model, const State& before,
                                              const State& after) {
  std::vector<ExternalContact> contacts(static_cast<std::size_t>(model.external_wheels));
  std::vector<double> scaled(static_cast<std::size_t>(model.unknowns));
  State at_step = before;
  at_step.input = after.input;
  place_in_step(model, after.steps, at_step, scaled.data(), contacts.data());
  return contacts;
}

double external_work(const Model& model, const std::vector<ExternalContact>& last,
                     const std::vector<ExternalContact>& now, const Configuration& moved) {
  if (model.form == Form::condensed) return work(model, now, moved);
  return .5 * (work(model, last, moved) + work(model, now, moved));
}

}  // namespace railstep
