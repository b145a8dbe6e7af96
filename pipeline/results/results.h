/// What a run writes and prints: records for the database, lines for people,
/// result.json, mesh files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/case_data/design_vectors.h"
#include "pipeline/study/study.h"

namespace meniscus::results {

/// Version of result.json's schema (docs/results.md).
inline constexpr int kResultSchemaVersion = 1;

nlohmann::ordered_json result_json(const case_data::Case& input,
                                   const study::RunResult& result,
                                   const std::string& program_version);

/// The result as a table for people: inputs, responses with errors, checks.
std::string result_text(const case_data::Case& input,
                        const study::RunResult& result);

/// What the case asks for, in the units that people read: "minimize mass; sway
/// at most 0.1 mm".
std::string study_text(const case_data::Case& input);

/// The film's report for people.
std::string film_text(const case_data::Case& input,
                      const settle::FilmReport& film);

/// film.vtp in `folder`.
void write_film(const case_data::Case& input, const SurfaceMesh& film,
                const std::filesystem::path& folder);

/// The meshed part with displacement and stress as a .vtu file; `notes` (name,
/// text) go in beside title, unit and load case.
void write_part(
    const std::filesystem::path& file, const case_data::Case& input,
    const forward::EvaluationFields& fields,
    const std::vector<std::pair<std::string, std::string>>& notes = {});

/// The boundary of the same, with its point data, as a .vtp file. `load_case`:
/// what the plain fields are of, so that several parts can be compared; empty
/// or none of the case's: the worst.
void write_part_surface(const std::filesystem::path& file,
                        const case_data::Case& input,
                        const forward::EvaluationFields& fields,
                        const std::string& load_case = "");

/// Names of film.vtp, part.vtu, part_surface.vtp and the case's STL files.
std::vector<std::string> mesh_names(const case_data::Case& input);

/// The same files of a finished run; the folder owns them (run_files.h).
/// Returns warnings of STL files whose film does not settle at their edge.
/// Throws IoError, Interrupted where `monitor` asks for a stop.
std::vector<std::string> write_meshes(const case_data::Case& input,
                                      const forward::EvaluationFields& fields,
                                      const std::filesystem::path& folder,
                                      const Monitor& monitor);

/// Where a surface could not be filled, for the eye: findings.vtp (places and
/// facets at fault) and unfilled_surface.vtp. Returns the names written, none
/// when there is no such surface. Throws IoError.
std::vector<std::string> write_unfilled(const forward::EvaluationFields& fields,
                                        const std::filesystem::path& folder);

/// The closed surface of a design, settled from its curves at another edge
/// length. Throws MeshError where there is no stable film.
SurfaceMesh settle_again(const case_data::EvaluatedCase& numbers, double edge);

/// "part_4.stl" for edge 4.
std::string stl_name(double edge);

/// history.csv and, last, result.json. Throws IoError.
void write_summary(const case_data::Case& input, const study::RunResult& result,
                   const std::vector<store::EvaluationRecord>& records,
                   const std::string& program_version,
                   const std::filesystem::path& folder);

/// How many of the row's variables stand at that bound, "lower" or "upper".
std::size_t count_at_bound(const case_data::Case& input,
                           const case_data::DesignRow& row,
                           const VectorX& design, std::string_view side);

/// "lower" or "upper" where a variable stands at a bound, to 1e-5 of its range.
std::string bound_reached(const case_data::DesignVariable& variable,
                          double value);

}  // namespace meniscus::results
