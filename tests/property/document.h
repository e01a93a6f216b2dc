#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace railstep::property {

/// A scene as in its file: tables, arrays of tables, values. (It is a map, so references stay valid
/// while keys are added.)
using Document = nlohmann::json;

/// The scene as TOML: tables or arrays of tables at the top, all below them inline.
std::string text_of(const Document& scene);

/// The scene of a TOML file. Throws std::runtime_error.
Document document_of(const std::filesystem::path& file);

/// A number of a table, or `otherwise` if the table does not have it.
double number(const Document& table, const char* key, double otherwise = 0.);
std::string word(const Document& table, const char* key, const char* otherwise = "");

/// All tables of an array, empty if the scene does not have it. (Where the scene may be changed,
/// scene[name] is enough: a null entry is not written.)
const Document& tables(const Document& scene, const char* name);

/// Calls `change` with the key and the value of every entry of every table, the outermost first.
void for_each_entry(Document& scene,
                    const std::function<void(const std::string& key, Document& value)>& change);

/// Calls `change` with every number in a value, at any depth.
void for_each_number(Document& value, const std::function<void(Document& number)>& change);

}  // namespace railstep::property
