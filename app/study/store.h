// The traces of an output folder: runs.jsonl, a line of JSON for each, and what single jobs wrote
// beside it.
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>

#include "app/study/run.h"

namespace app {

enum class StoreMode {
  kGoOn,     // what is there from the same inputs is not run again
  kFresh,    // everything is
  kCollect,  // nothing is run
  kLook,     // nothing is, and nothing is written
};

class Store {
 public:
  // `job`: whose own file takes what is new; empty: the folder's, which takes what is in those of
  // all jobs. Lines that are torn, or of another program, are left out.
  Store(std::filesystem::path folder, StoreMode mode, const std::string& job);

  // From the same inputs; null: it is not there, or was skipped.
  const Trace* find(const RunKey& key, const std::string& inputs) const;
  // The trace that is there, or what `make` gives, kept at once. Where nothing is to be run it is
  // marked as missing. None: interrupted. From any thread.
  std::optional<Trace> findOr(const RunKey& key, const std::string& inputs,
                              const std::function<std::optional<Trace>()>& make);
  // The same, whatever is there.
  std::optional<Trace> remake(const RunKey& key, const std::string& inputs,
                              const std::function<std::optional<Trace>()>& make);
  double secondsOf(const RunKey& key) const;  // when it was run last, from any inputs; else 0

  int reused() const { return reused_; }
  int missing() const { return missing_; }
  bool runs() const { return mode_ == StoreMode::kGoOn || mode_ == StoreMode::kFresh; }

 private:
  void read(const std::filesystem::path& file);
  void append(const Trace& trace);

  std::filesystem::path path_;
  StoreMode mode_;
  std::map<std::string, Trace> earlier_;  // by key and inputs
  std::mutex mutex_;
  std::atomic<int> reused_ = 0, missing_ = 0;
};

// The hash of all that a trace depends on: these, and this program.
std::string hashInputs(const std::vector<std::string>& parts);

// A trace as a line, and back; throws where the line is none.
std::string lineOf(const Trace& trace);
Trace parseTrace(const std::string& line);

// points.csv: a line for the heads, then one for each trace. Numbers carry 9 digits.
std::string pointsTable(const std::vector<Trace>& traces);

}  // namespace app
