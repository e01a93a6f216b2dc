#pragma once
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>

namespace railstep::fuzz {

/// A text with one to three changes of its lines: another number in place of one, a line removed,
/// doubled, swapped or copied from another place, another value, bytes.
std::string changed_text(std::string_view text, std::mt19937_64& random);

/// For LLVMFuzzerCustomMutator: changed_text() three times out of four, else LLVMFuzzerMutate().
std::size_t mutate_text(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed);

}  // namespace railstep::fuzz

/// Defined by libFuzzer or by replay_main.cpp.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
