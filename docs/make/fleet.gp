# SPDX-License-Identifier: MIT
# Makespan by nodes, of fleet.py's table: gnuplot -e "csv='FLEET.csv'; out='OUT.svg'" fleet.gp
set terminal svg size 820,480 enhanced background '#ffffff' font 'sans-serif,13'
set output out
set datafile separator ','
set logscale xy
set grid lc rgb '#d8dde2'
set xlabel 'nodes (one core each)'
set ylabel 'time until 200 variants are done [s]'
curve(by, launch) = sprintf("< awk -F, '$1 == \"%s\" && $3 == %d' %s", by, launch, csv)
plot curve('part', 0) using 4:5 with linespoints lw 2 lc rgb '#0a5fb4' title 'by part', \
  curve('triangles=50000', 0) using 4:5 with linespoints lw 2 lc rgb '#2f7d32' title 'by 50,000 triangles', \
  curve('part', 1) using 4:5 with linespoints lw 2 dt 2 lc rgb '#0a5fb4' title 'by part, 1 s to start a process', \
  curve('triangles=50000', 1) using 4:5 with linespoints lw 2 dt 2 lc rgb '#2f7d32' title 'by 50,000 triangles, 1 s to start a process'
