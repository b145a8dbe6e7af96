/// From the checked tables of a file to the entries of a Case. Part of the
/// case-file reader.
#pragma once

#include <string>
#include <vector>

#include "pipeline/case_data/case.h"
#include "pipeline/reader/case_reader_fields.h"

namespace meniscus::reader {

/// Everything: the case's entries, and what is wrong in `problems`.
void read_tables(const toml::table& root, const OverriddenNodes& overridden,
                 case_data::CaseProblems& problems, case_data::Case& result);

/// Design variables and parameters, the names that expressions know: first of
/// all.
void read_names(CaseContext& context, const toml::table& root,
                case_data::Case& result);

/// Where films begin, an earlier run or values by name, once names and units
/// are known.
void read_start(CaseContext& context, const toml::table& root,
                case_data::Case& result);

/// Of those that nothing uses; last of all.
void warn_of_unused(CaseContext& context, const toml::table& root,
                    const case_data::Case& result);

/// Notes what is no name of an entry of `table`.
void check_name(CaseContext& context, const std::string& name,
                const std::string& table, case_data::SourceLine line);

/// The tables [`table`.NAME] in the order of the file.
std::vector<CaseTable> named_tables(CaseContext& context,
                                    const toml::table& root, const char* table);

/// The table [`table`], when there is one.
std::optional<CaseTable> single_table(CaseContext& context,
                                      const toml::table& root,
                                      const char* table);

/// Curves, of which some may come from files.
void read_curves(CaseContext& context, const toml::table& root,
                 case_data::Case& result);

/// How a copy is turned and moved: `rotate` about `axis` through `about`, then
/// `move`.
void read_motion(CaseContext& context, const CaseTable& table,
                 case_data::CurveEntry& curve);

/// A curve of kind "file": its points, or the curve of STEP edges.
void read_curve_file(CaseContext& context, const CaseTable& table,
                     case_data::Case& result, case_data::CurveEntry& curve);

/// The curve of edges of a STEP file that close, by names or numbers; problems
/// are those of the key `at`. False where it is none, which has been noted.
bool read_step_loop(CaseContext& context, const CaseTable& table,
                    const std::string& path,
                    const std::vector<std::string>& edges, const char* at,
                    case_data::Case& result, case_data::CurveEntry& curve);

/// What the points of a csv file make.
const std::vector<case_data::Named<case_data::CurveKind>>& point_curves();

/// The file that the case holds under that path; null where it does not yet.
const case_data::CaseFile* held_file(const case_data::Case& result,
                                     const std::string& path);

/// The text of the file that the key `file` names, from disk unless the case
/// holds it, which it does from then on. Null with a problem noted; `expected`
/// is for that.
const std::string* file_text(CaseContext& context, const CaseTable& table,
                             const std::string& path, const char* expected,
                             case_data::Case& result);

/// The ending of a file's name in lower case: ".step".
std::string ending_of(const std::string& path);

/// Bosses, flanges, lugs and blocks: kinds of [solids.NAME] that are curves and
/// faces.
struct FeatureRow {
  const char* name;
  case_data::FeatureKind kind;
  case_data::KindKeys keys;
  std::string_view doc;
};
const std::vector<FeatureRow>& feature_kinds();

bool is_feature(const CaseTable& table);

/// Those among the solids, and their edges among the curves; after the curves,
/// before the films.
void read_features(CaseContext& context, const std::vector<CaseTable>& solids,
                   case_data::Case& result);

/// The faces of the feature of that name, which must exist, among the solids.
void add_feature_faces(const std::string& name, case_data::Case& result);

/// Each name of a feature or STEP solid replaced by those of its faces.
std::vector<std::string> with_feature_faces(
    const case_data::Case& input, const std::vector<std::string>& names);

/// Solids of kind "step": the curves of their rims; after the curves, before
/// the films.
bool is_step_solid(const CaseTable& table);
void read_step_solids(CaseContext& context,
                      const std::vector<CaseTable>& solids,
                      case_data::Case& result);

/// The wall of kind "step" of a wetted solid: what its face lies on. Nothing,
/// and told, where there is no such face, or it is none that films slide on.
std::optional<films::FilmWall> read_wall_face(CaseContext& context,
                                              const CaseTable& table,
                                              case_data::Case& result);

/// The faces of the solid of that name among the solids; none where it could
/// not be read.
void add_step_faces(const std::string& name, case_data::Case& result);

/// After curves and features; solids, of their own tables, after the films.
void read_films(CaseContext& context, const toml::table& root,
                case_data::Case& result);
void read_solids(CaseContext& context, const std::vector<CaseTable>& solids,
                 case_data::Case& result);

/// Curves, features, films, solids, materials, bodies, in this order; sets
/// bodies_good.
void read_geometry(CaseContext& context, const toml::table& root,
                   case_data::Case& result);

/// Walls, shells, fillets, field energies and spines; after the geometry,
/// fillets after walls.
void read_walls(CaseContext& context, const toml::table& root,
                case_data::Case& result);
void read_shells(CaseContext& context, const toml::table& root,
                 case_data::Case& result);
void read_fillets(CaseContext& context, const toml::table& root,
                  case_data::Case& result);
/// One to three counts, each 1 or more; none without the key, or with a problem
/// noted.
std::vector<int> read_shape(CaseContext& context, const CaseTable& table,
                            const char* key);
/// Notes a shape in the quantity that has values on walls alone.
void require_space(CaseContext& context, const case_data::Case& result,
                   const case_data::PlaceQuantity& quantity);

/// Notes curves that shapes name and the case has not.
void check_rim_shapes(CaseContext& context, const case_data::Case& result);

/// Names that expressions of a film's fields know from then on.
void read_shapes(CaseContext& context, const toml::table& root,
                 case_data::Case& result);
void read_fields(CaseContext& context, const toml::table& root,
                 case_data::Case& result);
void read_spines(CaseContext& context, const toml::table& root,
                 case_data::Case& result);

/// The surface that a response or zone names with `key`: a film or solid that
/// encloses a body; empty without the key.
std::string surface_on(CaseContext& context, const CaseTable& table,
                       const case_data::Case& result, const char* key = "on");

/// The same of a load or support, which may name several with `on`.
loads::Surfaces surfaces_on(CaseContext& context, const CaseTable& table,
                            const case_data::Case& result,
                            const char* key = "on");

/// Supports and loads, those of bolts among all others; after the geometry.
void read_load_cases(CaseContext& context, const toml::table& root,
                     case_data::Case& result);

/// A constant above `above`; `standard` without the key or when it is wrong.
double constant_above(CaseContext& context, const CaseTable& table,
                      const char* key, double above, double standard);

/// The load case that `key` names; the first when left out or wrong.
int index_of_load_case(CaseContext& context, const CaseTable& table,
                       const case_data::Case& result,
                       const char* key = "load_case");

/// The same, or AnalysisEntry::kFree for "free" where no load case has that
/// name.
int index_of_held(CaseContext& context, const CaseTable& table,
                  const case_data::Case& result, const char* key);

/// After load cases and bodies.
void read_responses(CaseContext& context, const toml::table& root,
                    case_data::Case& result);

/// The members of a family, from tables or a csv file; the kind of each one's
/// own study.
std::string read_members(CaseContext& context, const CaseTable& study,
                         case_data::Case& result);

/// After the responses.
void read_study(CaseContext& context, const toml::table& root,
                case_data::Case& result);

/// Load cases, analysis, responses, study; after the geometry.
void read_analysis(CaseContext& context, const toml::table& root,
                   case_data::Case& result);

}  // namespace meniscus::reader
