/* Shares counted in a sample and their intervals; the order of a sample. */
#pragma once

#include <stdint.h>

/* The 95 % interval of a share seen `hits` times in n (Wilson, J. Am. Stat. Assoc. 22 (1927) 209); [0, 1] for n = 0. */
typedef struct {
  double share, low, high;
} kz_share;
kz_share kz_share_of(int64_t hits, int64_t n);
/* Interval for n distinct items of `total`: the variance is smaller by (total - n)/(total - 1). */
kz_share kz_share_of_part(int64_t hits, int64_t n, int64_t total);

/* Number of kinds that no sample has, where `once` and `twice` of them are in one and in two samples: Chao's estimate
 * without its bias, and its variance (A. Chao, Biometrics 43 (1987) 783). It is low where some kinds are much rarer
 * than others. */
typedef struct {
  double number, variance;
} kz_unseen;
kz_unseen kz_unseen_of(int64_t once, int64_t twice);
/* Its 95 % interval, from 0 on: the logarithm is taken as normal. */
void kz_unseen_interval(kz_unseen unseen, double *low, double *high);

/* The smallest sample size for which the upper bound is at most `share` if there is no hit. */
int64_t kz_share_sample(double share);

/* Number i, from 0 on, of a sequence that fills the unit square evenly (M. Roberts' R2). */
void kz_even_share(int64_t i, double share[2]);

/* Number `index` >= 1 of a random-looking sequence (SplitMix64: G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014,
 * 453). */
uint64_t kz_random_bits(uint64_t index);

/* Cell i of an order of the cells 0 .. total - 1 that looks random: a permutation, chosen by the seed. */
int64_t kz_shuffled(int64_t i, int64_t total, int64_t seed);
