/// What the commands share: reading a case aloud, folders, the monitor.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "app/commands.h"
#include "app/terminal_monitor.h"
#include "pipeline/reader/case_reader.h"

namespace meniscus::app {

/// Reads a case and prints its problems and warnings on stderr.
reader::CaseReading read_and_report_case(const std::string& path,
                                         const CommonArguments& common);

/// `out`, or results/<case name> below the working folder.
std::filesystem::path results_folder(const case_data::Case& input,
                                     const std::string& out);

/// Where what is no run goes: `out`, or results/<name>, with `ending` ("_film")
/// where that folder holds a run. Throws IoError where `out` does.
std::filesystem::path folder_without_run(const std::string& name,
                                         const std::string& out,
                                         const std::string& ending);

/// What stands before and behind the first '=' of the `text` that `option` was
/// given. Throws InvalidInput with both and what is `expected` where there is
/// none or nothing before it.
std::pair<std::string, std::string> named_text(const std::string& option,
                                               const std::string& text,
                                               const char* expected);

/// "NAME=VALUE" that `option` ("--at") was given; VALUE is an expression
/// without names. Throws InvalidInput, naming both, for anything else.
std::pair<std::string, double> named_number(const std::string& option,
                                            const std::string& text);

/// Options of a monitor that the stop signals stop.
TerminalMonitorOptions monitor_options(const CommonArguments& common);

}  // namespace meniscus::app
