#pragma once
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>

namespace railstep::fuzz {

/// A text of lines with one to three of these changed: another number in the place of one, a line
/// left out, doubled, moved or taken from another place, another word, bytes.
std::string changed_text(std::string_view text, std::mt19937_64& random);

/// For LLVMFuzzerCustomMutator: half of the time changed_text(), else LLVMFuzzerMutate().
std::size_t mutate_text(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed);

}  // namespace railstep::fuzz

/// Of libFuzzer, or of replay_main.cpp.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
