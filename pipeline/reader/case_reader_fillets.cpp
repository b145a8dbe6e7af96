#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "pipeline/reader/case_reader_tables.h"

namespace meniscus::reader {

namespace {

/// Curves at which films end, by all their names: what lies on another curve
/// is that one.
std::map<std::string, std::string> curves_of_films(
    const case_data::Case& result) {
  std::map<std::string, std::string> kept;
  for (const case_data::FilmEntry& film : result.films) {
    for (const std::string& curve : film.spec.curves) {
      kept[curve] = curve;
    }
  }
  for (const case_data::MergedCurves& merged : result.merged) {
    const std::string& name =
        result.curves[static_cast<std::size_t>(merged.kept)].name;
    if (kept.count(name) != 0) {
      kept[result.curves[static_cast<std::size_t>(merged.dropped)].name] = name;
    }
  }
  return kept;
}

/// The STEP solid whose edge the curve is; null for others.
const case_data::StepSolidEntry* step_solid_at(const case_data::Case& result,
                                               const std::string& curve) {
  for (const case_data::StepSolidEntry& solid : result.step_solids) {
    const auto& rims = solid.spec.rims;
    if (std::any_of(rims.begin(), rims.end(),
                    [&](const auto& rim) { return rim.curve == curve; })) {
      return &solid;
    }
  }
  return nullptr;
}

class FilletReader {
 public:
  FilletReader(CaseContext& context, case_data::Case& result)
      : context_(context), result_(result), kept_(curves_of_films(result)) {}

  void read(const CaseTable& table) {
    case_data::FilletEntry fillet{.name = table.name(),
                                  .curves = {},
                                  .radius = table.quantity_or_zero("radius"),
                                  .line = table.line()};
    for (const std::string& curve : table.names("curves")) {
      const auto at = kept_.find(curve);
      if (at == kept_.end()) {
        unknown(table, curve);
      } else if (is_new(table, at->second)) {
        fillet.curves.push_back(at->second);
      }
    }
    if (!result_.walls.empty()) {
      add(table, table.line(),
          "stands beside walls, whose films are rounded by the fillet of "
          "[walls]; take one of the two out");
    }
    result_.fillets.push_back(std::move(fillet));
  }

 private:
  void add(const CaseTable& table, case_data::SourceLine line,
           const std::string& text) {
    context_.problems.add(line, table.path() + " " + text);
  }

  void unknown(const CaseTable& table, const std::string& curve) {
    std::vector<std::string> known;
    known.reserve(kept_.size());
    for (const auto& [name, kept] : kept_) {
      known.push_back(name);
    }
    context_.problems.unknown(table.line("curves"), "curve of a film", curve,
                              known);
  }

  bool is_new(const CaseTable& table, const std::string& curve) {
    const case_data::SourceLine line = table.line("curves");
    if (const auto [first, is_first] = taken_.emplace(curve, table.name());
        !is_first) {
      add(table, line,
          fmt::format("rounds curve '{}', which fillets.{} does already; a "
                      "curve has one radius",
                      curve, first->second));
      return false;
    }
    if (const auto* solid = step_solid_at(result_, curve)) {
      add(table, line,
          fmt::format("rounds curve '{}', an edge of the STEP solid '{}', "
                      "whose faces stay as they are; round other curves, or "
                      "model the fillet in the file",
                      curve, solid->spec.name));
      return false;
    }
    return true;
  }

  CaseContext& context_;
  case_data::Case& result_;
  std::map<std::string, std::string> kept_;
  std::map<std::string, std::string> taken_;  // by which fillet
};

}  // namespace

TableSpec fillet_table() {
  using D = Dimension;
  using K = KeyType;
  return {"fillets",
          true,
          TableNeed::Optional,
          "Corners along curves where films meet solids or each other, rounded",
          {{"curves", K::Names, D::None, true,
            "of films: each where a film and one other surface of the part "
            "meet"},
           {"radius", K::Quantity, D::Length, true,
            "of the ball that rolls along; 0: sharp"}}};
}

void read_fillets(CaseContext& context, const toml::table& root,
                  case_data::Case& result) {
  FilletReader reader(context, result);
  for (const CaseTable& table : named_tables(context, root, "fillets")) {
    reader.read(table);
  }
}

}  // namespace meniscus::reader
