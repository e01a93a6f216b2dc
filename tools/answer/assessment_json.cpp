#include "answer/assessment.h"

namespace railstep {

const char* name_of(SectionKind kind) {
  switch (kind) {
    case SectionKind::straight:
      return "straight";
    case SectionKind::transition:
      return "transition";
    case SectionKind::curve:
      break;
  }
  return "curve";
}

namespace {

using Json = nlohmann::ordered_json;

/// A value and its limit in SI, which NaN makes null.
Json values_json(const std::vector<AssessedValue>& values) {
  Json all = Json::object();
  for (const AssessedValue& value : values)
    all[text_of(value.quantity).key] = {
        {"where", value.where}, {"value", value.value}, {"limit", value.limit}};
  return all;
}

Json sections_json(const std::vector<AssessedSection>& sections) {
  Json all = Json::array();
  for (const AssessedSection& section : sections)
    all.push_back({{"kind", name_of(section.kind)},
                   {"from_m", section.from},
                   {"to_m", section.to},
                   {"radius_m", section.radius},
                   {"speed_m_per_s", section.speed},
                   {"uncompensated_m_per_s2", section.across},
                   {"values", values_json(section.values)}});
  return all;
}

Json estimates_json(const std::vector<EstimatedValue>& estimates) {
  Json all = Json::array();
  for (const EstimatedValue& own : estimates)
    all.push_back({{"track", own.track},
                   {"quantity", text_of(own.quantity).key},
                   {"sections", own.sections},
                   {"estimate", own.estimate},
                   {"limit", own.limit}});
  return all;
}

Json ride_json(const std::vector<RideComfort>& ride) {
  Json all = Json::array();
  for (const RideComfort& own : ride)
    all.push_back({{"sensor", own.sensor},
                   {"blocks", own.blocks},
                   {"mean_comfort", own.comfort},
                   {"weighted_y_m_per_s2", own.weighted_y},
                   {"weighted_z_m_per_s2", own.weighted_z},
                   {"ride_index_y", own.index_y},
                   {"ride_index_z", own.index_z}});
  return all;
}

}  // namespace

Json to_json(const std::vector<AssessedVehicle>& vehicles) {
  Json all = Json::array();
  for (const AssessedVehicle& vehicle : vehicles)
    all.push_back({{"vehicle", vehicle.name},
                   {"nadal_y_over_q", vehicle.nadal},
                   {"sections", sections_json(vehicle.sections)},
                   {"estimates", estimates_json(vehicle.estimates)},
                   {"ride", ride_json(vehicle.ride)}});
  return all;
}

}  // namespace railstep
