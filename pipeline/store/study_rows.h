/// Between evaluation records and the rows of the study database. Nothing but
/// the study store includes this.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/store/study_store.h"
#include "pipeline/store/study_store_sqlite.h"

namespace meniscus::store {

/// The table of evaluations and its index, as SQL.
extern const char* const kEvaluationTable;

/// What tells whether bytes changed since they were written: SQLite checks its
/// own pages' structure, not what stands in them.
std::string checksum_of(std::initializer_list<std::string_view> parts);

/// Inserts the record and returns its number. Throws InvalidInput for one whose
/// parts do not fit together.
int insert_row(const SqliteDatabase& database, const std::string& case_hash,
               const EvaluationRecord& record);

/// Replaces the gradient of a record that is there. Throws as insert_row().
void replace_gradient(const SqliteDatabase& database, int number,
                      const Eigen::MatrixXd& gradient);

/// The records that fulfil `condition` ("WHERE ..." with at most one "?", for
/// `key`; may be empty), by number. Throws IoError for one that is damaged.
std::vector<EvaluationRecord> select_rows(const SqliteDatabase& database,
                                          const std::string& condition,
                                          const std::string& key = {});

/// Of case hash, model and the exact bits of the inputs; 0 and -0 are one.
std::string key_of(const std::string& case_hash, const std::string& model,
                   const VectorX& inputs);

}  // namespace meniscus::store
