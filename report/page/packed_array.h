/// Numbers as the report page takes them: little-endian bytes in base64 with
/// what it needs to read them (report/web/src/packed.ts).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace meniscus::page {

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// `components` numbers per item, all of one item before the next, each
/// component in 65535 even steps over its own range: an error of at most
/// 1/131068 of it. What is not finite stays so (NaN). Throws InvalidInput when
/// the values are no multiple of the components.
nlohmann::ordered_json pack_reals(const std::vector<double>& values,
                                  int components);

/// Whole numbers from 0 in the fewest of 1, 2 or 4 bytes each.
nlohmann::ordered_json pack_ids(const std::vector<int>& ids);

}  // namespace meniscus::page
