#pragma once
#include "online/model/model.h"

namespace railstep {

// The contacts with the rails are numbered: left and right tread of each wheelset in turn, the
// wheels of all vehicles, then left and right flange of each wheelset that has them. Treads and
// vehicles' wheels together are the wheels. Only this header computes with these numbers. A side
// is 0 left, 1 right; a wheelset's side is on the rail of the same number.
struct ContactId {
  std::int32_t number;
  constexpr operator std::int32_t() const noexcept { return number; }  // as an index
};

/// Contacts in the order of their numbers.
struct ContactIds {
  struct Place {
    std::int32_t number;
    constexpr ContactId operator*() const noexcept { return {number}; }
    constexpr Place& operator++() noexcept {
      ++number;
      return *this;
    }
    constexpr bool operator!=(Place other) const noexcept { return number != other.number; }
  };
  std::int32_t first, past;
  constexpr Place begin() const noexcept { return {first}; }
  constexpr Place end() const noexcept { return {past}; }
};

inline constexpr int kMaxFlanges = 2 * kMaxWheelsets;

inline std::int32_t tread_count(const Model& model) noexcept { return 2 * model.wheelsets; }
inline std::int32_t wheel_count(const Model& model) noexcept {
  return tread_count(model) + model.vehicle_wheels;
}
inline std::int32_t flange_count(const Model& model) noexcept { return 2 * model.flanges; }
inline std::int32_t contact_count(const Model& model) noexcept {
  return wheel_count(model) + flange_count(model);
}

inline ContactIds treads(const Model& model) noexcept { return {0, tread_count(model)}; }
inline ContactIds upright_wheels(const Model& model) noexcept {
  return {tread_count(model), wheel_count(model)};
}
/// Treads and upright wheels.
inline ContactIds wheels(const Model& model) noexcept { return {0, wheel_count(model)}; }
inline ContactIds contacts(const Model& model) noexcept { return {0, contact_count(model)}; }

// The track is touched along rows: one of each contact, then those of the seats of runners' wheels,
// left and right of each wheelset in turn: along y and z at the centre of the crown, and roll of
// the section. Rigid rails have no seats.
inline constexpr int kWheelSeatRows = 3;

inline std::int32_t wheel_seat_row_count(const Model& model) noexcept {
  return model.lines > 0 ? 2 * kWheelSeatRows * model.runner_wheelsets : 0;
}
inline std::int32_t track_row_count(const Model& model) noexcept {
  return contact_count(model) + wheel_seat_row_count(model);
}
/// The first row of the seat under a runner's wheel, among all rows of the track.
/// @param wheelset  among those of all runners
inline std::int32_t wheel_seat_row(const Model& model, std::int32_t wheelset,
                                   std::int32_t side) noexcept {
  return contact_count(model) + kWheelSeatRows * WheelId{wheelset, side}.number();
}

/// The tread of a wheelset on a side.
constexpr ContactId tread_of(std::int32_t wheelset, std::int32_t side) noexcept {
  return {2 * wheelset + side};
}
/// The tread on the other side of the same wheelset.
constexpr ContactId other_tread(ContactId tread) noexcept { return {tread.number ^ 1}; }
/// The contact of a wheel by its number among the wheels of all vehicles.
inline ContactId vehicle_contact(const Model& model, std::int32_t vehicle_wheel) noexcept {
  return {tread_count(model) + vehicle_wheel};
}
/// A flange's number among all flanges. @param pair  the model's FlangeModel
constexpr std::int32_t flange_number(std::int32_t pair, std::int32_t side) noexcept {
  return 2 * pair + side;
}
inline ContactId flange_contact(const Model& model, std::int32_t flange) noexcept {
  return {wheel_count(model) + flange};
}
/// The model's FlangeModel of a flange's contact.
inline std::int32_t flange_pair(const Model& model, ContactId flange) noexcept {
  return (flange.number - wheel_count(model)) / 2;
}

inline bool is_flange(const Model& model, ContactId contact) noexcept {
  return model.contact[contact].kind == ContactKind::flange;
}
/// Whether a contact is the upright wheel of a vehicle; else it is of a wheelset.
inline bool is_upright(const Model& model, ContactId contact) noexcept {
  return model.contact[contact].kind == ContactKind::wheel;
}
/// The bodies that carry a contact.
inline const SuspendedModel& bodies_of(const Model& model, ContactId contact) noexcept {
  const ContactModel& own = model.contact[contact];
  if (is_upright(model, contact)) return model.vehicle[own.bodies];
  return model.wheelset[own.bodies];
}

/// The place of a contact at t = 0 along the model's elements, m.
inline double place_of(const Model& model, ContactId contact) noexcept {
  return bodies_of(model, contact).start + model.contact[contact].place;
}

/// The contacts of one wheelset: its treads and, if it has them, its flanges.
struct WheelsetContacts {
  int count;          // 2 or 4
  std::int32_t pair;  // the model's FlangeModel; -1: it has none
  ContactId at[4];    // left tread, right tread, left flange, right flange
};
inline WheelsetContacts contacts_of(const Model& model, std::int32_t wheelset) noexcept {
  const ContactId left = tread_of(wheelset, 0), right = tread_of(wheelset, 1);
  for (std::int32_t pair = 0; pair < model.flanges; ++pair)
    if (model.flange[pair].wheelset == wheelset)
      return {4,
              pair,
              {left, right, flange_contact(model, flange_number(pair, 0)),
               flange_contact(model, flange_number(pair, 1))}};
  return {2, -1, {left, right, {}, {}}};
}

}  // namespace railstep
