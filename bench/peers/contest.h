#pragma once
#include <functional>
#include <string>
#include <vector>

namespace railstep {

/// One way to step a scene, with its error; its time is measured in turns with the others'.
struct Contestant {
  std::string peer, scene;
  int elements;  // of a rail or a beam
  double step;   // s; 0: chosen by the tolerance
  double error;  // moving_load: largest over peak after start-up; double_pendulum: of C, m
  double error_from_start;        // the same from the first step on; NaN: not known
  double reference_error;         // of the reference of `error`, in its unit
  int unknowns;                   // in all
  double flops;                   // of 1 ms; NaN: not counted
  std::function<double()> frame;  // 1 ms; the result only prevents its removal by the compiler
  int passage = 0;                // frames timed together at least; 0: enough for 2 ms
  std::vector<double> us = {};    // for 1 ms, one per round
};

/// Each round times a block of every contestant, one after the other, so a slow minute of the
/// machine slows all of them.
void hold_contest(std::vector<Contestant>& all, int rounds);

/// CSV: peer,scene,elements,step_s,us_per_ms,error,reference_error,us_low,us_high,unknowns,
/// flops_per_ms,error_from_start. Times are the median and the quartiles of the rounds.
void print_head();
void print_rows(const std::vector<Contestant>& all);

/// The scenes' contestants. @param elements  of a rail
std::vector<Contestant> moving_load_contest(int elements);
std::vector<Contestant> work_precision_contest(int elements);
std::vector<Contestant> double_pendulum_contest();

}  // namespace railstep
