#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace railstep {

/// The inputs of frames for which nothing comes from outside. They are the last inputs; after
/// `silence` frames without inputs follows a safe stop: for the rest of the run the inputs go to 0
/// in equal steps over `ramp` frames and stay there, whatever comes. Places, which are not forces,
/// stay where they are. The silence counts from the first inputs on; before them all are 0.
class HeldInputs {
 public:
  /// @param silence  frames; 0: inputs are held for ever
  /// @param places   indices of inputs
  HeldInputs(std::size_t count, std::int64_t silence, std::int64_t ramp,
             std::vector<std::size_t> places = {})
      : silence_(silence),
        ramp_(ramp),
        places_(std::move(places)),
        value_(count, 0.),
        base_(count, 0.) {}

  /// The inputs of the next frame. @param fresh  [count], or null where nothing came
  /// @param good   [count] what the model holds: its last good inputs within their limits
  /// @returns [count]
  const double* next(const double* fresh, const double* good) noexcept;

  /// Whether something ever came.
  bool heard() const noexcept { return heard_; }
  bool stopping() const noexcept { return stopped_for_ > 0; }

 private:
  std::int64_t silence_, ramp_;
  std::int64_t silent_ = 0, stopped_for_ = 0;  // frames
  bool heard_ = false;
  std::vector<std::size_t> places_;
  std::vector<double> value_, base_;
};

}  // namespace railstep
