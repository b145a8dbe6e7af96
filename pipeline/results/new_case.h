/// A commented case to start from.
#pragma once

#include <string>

namespace meniscus::results {

/// The text of NAME/case.toml: a strut between two rings under load, every
/// table that a case needs, each line explained. It reads back without
/// problems and runs in seconds.
std::string new_case_text(const std::string& name);

}  // namespace meniscus::results
