#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace railstep::property {

/// A scene as its file has it: tables, arrays of tables, values. (A map: references stay good while
/// keys are added.)
using Document = nlohmann::json;

/// As TOML: a table or an array of tables at the top, all below it inline.
std::string text_of(const Document& scene);

/// Of a TOML file. Throws std::runtime_error.
Document document_of(const std::filesystem::path& file);

/// A number of a table, or what is taken where it is left out.
double number(const Document& table, const char* key, double otherwise = 0.);
std::string word(const Document& table, const char* key, const char* otherwise = "");

/// All tables of an array, none where it is left out. (Of a scene that may change, scene[name]
/// does: what is null is not written.)
const Document& tables(const Document& scene, const char* name);

/// Calls `change` with the key and the value of every entry of every table, the outermost first.
void for_each_entry(Document& scene,
                    const std::function<void(const std::string& key, Document& value)>& change);

/// Calls `change` with every number in a value, however deep.
void for_each_number(Document& value, const std::function<void(Document& number)>& change);

}  // namespace railstep::property
