#!/bin/sh
# Makes a synthetic table for `heddle discover configs/discover/stamping.yaml`: the same stamping on a finer grid with
# more steps, other numbers and one hidden term, with scatter. Nothing here was measured.
#   configs/data/make_stamping_force.sh PROGRAM FOLDER SEED KEY=VALUE... > TABLE.csv
# PROGRAM is heddle, FOLDER keeps its runs, each KEY=VALUE goes to --set: the hidden term. The shipped table:
#   configs/data/make_stamping_force.sh ./heddle out/stamping_force 20251 fabric.shear_rate=on > configs/data/stamping_force.csv
# and its two decoys: seed 20252 with artefact.mass_scaling=300, and seed 20253 with nothing hidden.
set -eu
program=$1 folder=$2 seed=$3
shift 3
# Each KEY=VALUE behind its own --set, spaces of a value kept.
for assignment in "$@"; do
  set -- "$@" --set "$assignment"
  shift
done
for speed in 0.5 0.7 1 1.4 2; do
  "$program" run configs/discover/stamping.yaml -o "$folder/$speed" --quiet --force --set process.punch.speed_scale=$speed \
    --set blank.spacing='6 mm' --set process.steps=48 --set blank.grid_error=off --set blank.symmetry=none --set friction.coefficient=0.28 \
    --set forming.tow_friction=0.23 "$@" > "$folder.$speed.log" 2>&1 || { cat "$folder.$speed.log" >&2; exit 1; }
done
echo "condition_id,sample_id,day_id,speed_scale,binder_force_N,tool_temperature_C,blank_temperature_C,orientation_deg,punch_displacement_mm,punch_force_N"
for speed in 0.5 0.7 1 1.4 2; do
  for sample in 1 2 3 4 5; do
    # Each sample: a gain of 2.5 % for the curve and 1 % a point. Park and Miller's generator, exact in doubles, so
    # that every awk draws the same.
    awk -F, -v speed=$speed -v sample=$sample -v seed="$seed" '
      function uniform() { x = (16807 * x) % 2147483647; return x / 2147483647 }
      function normal(  u, v) { u = uniform(); v = uniform(); return sqrt(-2 * log(u)) * cos(6.283185307179586 * v) }
      BEGIN { x = seed * 97 + sample * 1009 + int(speed * 10) * 10007; for (k = 0; k < 20; k++) uniform(); gain = 1 + 0.025 * normal() }
      NR > 1 && $2 >= 8 { printf "V%s,V%s-%s,d1,%s,650,85,180,0,%.4f,%.3f\n", speed, speed, sample, speed, $2, $3 * gain * (1 + 0.01 * normal()) }
    ' "$folder/$speed/macroscale/history.csv"
  done
done
