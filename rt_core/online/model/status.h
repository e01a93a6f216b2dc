#pragma once
#include <cstdint>

namespace railstep {

/// Events of a frame; several bits can be set, and stepping continues.
enum class Status : std::uint32_t {
  ok = 0,
  off_rail = 1u << 0,         // a load or wheel left the rail, its force is 0: lengthen the track
  contact_lost = 1u << 1,     // a wheel stood free of its rail during the frame
  cap_reached = 1u << 2,      // contact, joint or projection hit its cap: shorten dt
  nonfinite_state = 1u << 3,  // the state is no longer finite: Outputs name the first bad unknown
  contact_unresolved = 1u << 4,  // a wheel struck its rail for fewer than 10 steps: shorten dt
  redundant_joint = 1u << 5,     // a joint row depended on others: it has no force of its own
  large_turn = 1u << 6,          // a rail or a body turned so far that its linear form is off
  nonfinite_input = 1u << 7,     // an input was not finite: its last good value was held
  force_saturated = 1u << 8,     // an input was beyond its limit, and cut to it
  contact_ill_posed = 1u << 9,   // compliances of contacts that are impossible
  full_slip = 1u << 10,          // the creep of a wheel has saturated
  beyond_profile = 1u << 11,     // a wheel touches at the end of a profile, or is beside its rail
};

constexpr Status operator|(Status a, Status b) noexcept {
  return static_cast<Status>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr Status operator&(Status a, Status b) noexcept {
  return static_cast<Status>(static_cast<std::uint32_t>(a) & static_cast<std::uint32_t>(b));
}
constexpr bool has(Status status, Status bit) noexcept {
  return (static_cast<std::uint32_t>(status) & static_cast<std::uint32_t>(bit)) != 0u;
}

/// A bit's name in JSON and traces, its meaning and what to do about it.
struct StatusText {
  Status bit;
  const char* name;
  const char* sentence;
};
inline constexpr StatusText kStatusTexts[] = {
    {Status::off_rail, "off_rail",
     "a load or wheel is off the rail and its force is 0: lengthen the track"},
    {Status::contact_lost, "contact_lost", "a wheel stood free of its rail for a while"},
    {Status::cap_reached, "cap_reached",
     "a solve of contact, guide or joints ended at its cap: shorten step.dt_s or raise the cap"},
    {Status::contact_unresolved, "contact_unresolved",
     "a wheel struck its rail for fewer than 10 steps: its peak force is not right, shorten "
     "step.dt_s"},
    {Status::redundant_joint, "redundant_joint",
     "a row of a joint hangs on others and carries no force of its own: leave it out, or hold the "
     "joints by the augmented Lagrangian"},
    {Status::large_turn, "large_turn",
     "a rail under a wheel rolled by more than 0.14 rad, where the linear rail's roll is off by 1 "
     "% and more, or a body of a rail vehicle turned by more than 0.1 rad: give the pads roll "
     "stiffness, or less lateral force"},
    {Status::nonfinite_input, "nonfinite_input",
     "an input was not a finite number, and its last good value was held"},
    {Status::force_saturated, "force_saturated",
     "an input was beyond its limit, and was cut to it: see limit_n of its force"},
    {Status::contact_ill_posed, "contact_ill_posed",
     "the compliance between contacts is not positive or not finite, and their forces are not "
     "right: set condense.residual_flexibility = false"},
    {Status::full_slip, "full_slip",
     "the creep of a wheel has saturated: friction limits its force, and more creep does not "
     "change "
     "it"},
    {Status::beyond_profile, "beyond_profile",
     "a wheel touches its rail at the end of a profile, or is beside it, and forces are not right: "
     "give "
     "profiles that reach farther"},
    {Status::nonfinite_state, "nonfinite_state", "the state is no longer finite"},
};

/// Text of the first of these bits that is set; null if none is.
const StatusText* text_of(Status status) noexcept;

}  // namespace railstep
