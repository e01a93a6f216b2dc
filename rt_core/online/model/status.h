#pragma once
#include <cstdint>

namespace railstep {

/// What a frame met; several can be true, the step goes on.
enum class Status : std::uint32_t {
  ok = 0,
  off_rail = 1u << 0,         // a load or wheel left the rail, its force is 0: lengthen the track
  contact_lost = 1u << 1,     // a wheel stood free of its rail during the frame
  cap_reached = 1u << 2,      // contact, joint or projection hit its cap: shorten dt
  nonfinite_state = 1u << 3,  // the state is no longer finite: Outputs name the first bad unknown
  contact_unresolved = 1u << 4,  // a wheel struck its rail for fewer than 10 steps: shorten dt
  redundant_joint = 1u << 5,     // a joint row hung on others: it carries no force of its own
  large_turn = 1u << 6,          // a rail under a wheel rolled so far that its linear form is off
  nonfinite_input = 1u << 7,     // an input was not finite: its last good value was held
  force_saturated = 1u << 8,     // an input was beyond its limit, and cut to it
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

}  // namespace railstep
