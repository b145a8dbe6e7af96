/// Terminals and pipes.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace meniscus::app {

/// A stream that understands cursor movements (TERM is not "dumb").
bool is_terminal(std::FILE* stream);

/// Its width; 80 of one that does not tell.
int columns_of(std::FILE* stream);

/// At most `columns` characters of UTF-8 text, on one line.
std::string truncate_to(const std::string& text, int columns);

/// A line each, to stderr.
void warn(const std::vector<std::string>& warnings);

}  // namespace meniscus::app
