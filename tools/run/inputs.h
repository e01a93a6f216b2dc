#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "offline/energy/frame_inputs.h"

namespace railstep {

/// A table over time of some inputs of a run. A row holds from its time until the time of the next
/// row. Before the first row, and for inputs without a column, the input is 0.
class InputTable {
 public:
  /// Columns time_s and names of inputs, as the model has them (NAME.force_n, NAME.moment_n_m);
  /// times rise from 0 or later. Throws InputError, with the line, on anything else.
  /// @param names    of the model's inputs
  /// @param frame_s  length of a frame, s
  InputTable(const std::filesystem::path& file, const std::vector<std::string>& names,
             double frame_s);

  /// The inputs of the frame that begins at frame * frame_s; a row within 1e-6 of a frame of it
  /// counts. Frames are asked for in any order. @returns [names]
  const double* at(std::int64_t frame) const;

 private:
  std::size_t width_;
  std::vector<std::int64_t>
      first_;                  // [rows + 1] frames from which each holds; 0 the row before all
  std::vector<double> value_;  // [rows + 1][width]
};

}  // namespace railstep
