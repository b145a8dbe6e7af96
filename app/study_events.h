/// What a study tells, as lines for people and records for the log.
#pragma once

#include <string>

#include "app/terminal_monitor.h"
#include "pipeline/study/study.h"

namespace meniscus::app {

/// Of an evaluation that has ended.
MonitorEvent evaluation_event(const case_data::Case& input,
                              const study::EvaluationEvent& event);

/// Of a run, for the log only. `seconds`: it took.
MonitorEvent end_event(study::RunStatus status, const std::string& message,
                       double seconds);

/// The stage whose progress the events of a study tell in more words.
std::string outer_stage_of(const case_data::Case& input);

}  // namespace meniscus::app
