#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace railstep {

/// A line of numbers that is not empty. Commas, blanks, tabs or semicolons separate its fields.
/// Views into the text.
struct CsvLine {
  int number;         // from 1
  std::string place;  // "file:number"
  std::string_view text;
  std::vector<std::string_view> fields;
};

/// Lines that are neither empty nor comments ('#'). A byte-order mark, LF, CRLF and CR are read.
std::vector<CsvLine> csv_lines(std::string_view text, const std::string& file);

/// Whether a field begins like a name and not like a number.
bool is_column_name(std::string_view field);

/// A finite number. Throws InputError naming the place.
double csv_number(std::string_view field, const std::string& place);

/// "73,5;0", "73,5 0,0" or "73,5,0,0": a comma between digits, where `wanted` values are expected
/// and more are there, up to twice as many. Throws InputError.
void refuse_decimal_comma(const CsvLine& line, std::size_t wanted);

}  // namespace railstep
