/// The built page without data, from report/web.
#pragma once

#include <string_view>

namespace meniscus::page {

/// HTML with kPageDataMark once, where the data go; empty when the program was
/// built without npm.
std::string_view page_template();

/// Stands as JSON text of its own in the template.
inline constexpr std::string_view kPageDataMark = "\"@MENISCUS_DATA@\"";

}  // namespace meniscus::page
