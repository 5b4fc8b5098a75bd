#pragma once

#include <span>
#include <vector>

/// Tails of distributions for tests of significance, and many tests together.
namespace tessera::volume {

/// Probability that a normal variable is beyond `z`, on either side of 0.
double normalTails(double z);
/// Probability that |t| is beyond Student's `t` with so many degrees of freedom, which need not be whole; 1 for none.
double studentTails(double t, double freedom);
/// Probability that a square of a normal variable, less 1, is beyond `x`: the bound of the null distribution of n times
/// the bias-corrected distance correlation (C. Shen, S. Panda, J. T. Vogelstein, The chi-square test of distance
/// correlation, 2022).
double distanceTail(double x);
/// Probability of a Kolmogorov-Smirnov distance of two samples at least this large (M. A. Stephens, 1970). `samples`: n
/// m / (n + m).
double kolmogorovTail(double distance, double samples);
/// Two-sided p-value of a Pearson correlation of so many independent samples; 1 below 4.
double correlationTail(double r, double samples);

/// The value of rising `sorted`, which has some, below which this share of them lies.
double rankedQuantile(std::span<const float> sorted, double share);

/// How many of `samples` values are expected as far out as `value` by chance, if the tail is exponential, and twice as
/// wide as between its median and its upper quartile: more than in normal or uniform noise and in squares of it, so
/// that these are never surprising. `sorted`: distances from the middle, all of at least 0, rising. `least`: of the
/// scale of the tail.
double expectedBeyond(std::span<const float> sorted, double value, double samples, double least);

/// The least false discovery rate at which each test is a finding, for any number of tests whose p-values rise or fall
/// together (Y. Benjamini, Y. Hochberg, Controlling the false discovery rate, 1995). NaN counts as 1.
std::vector<double> falseDiscoveryRates(std::span<const double> p);

} // namespace tessera::volume
