/// Internal to fe_commands: words that are commands of themselves.
#pragma once

#include <set>
#include <string>

namespace meniscus::datafile {

using CommandWords = std::set<std::string, std::less<>>;

const CommandWords& command_words();     // with a number behind, or without
const CommandWords& command_toggles();   // with on or off behind, or without
const CommandWords& element_commands();  // with elements behind

}  // namespace meniscus::datafile
