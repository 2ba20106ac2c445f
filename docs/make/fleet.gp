# SPDX-License-Identifier: MIT
# Makespan by nodes, of fleet.py's table: gnuplot -e "csv='FLEET.csv'; out='OUT.svg'" fleet.gp
set terminal svg size 860,540 dynamic enhanced background '#ffffff' font 'sans-serif,14'
set output out
set datafile separator ','
set logscale xy
set xrange [1:1000]
set yrange [20:20000]
set xtics (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
set ytics ('10 s' 10, '30 s' 30, '1 min' 60, '3 min' 180, '10 min' 600, '30 min' 1800, '1 h' 3600, '3 h' 10800)
set border 3 lc rgb '#445566'
set tics nomirror
set grid lc rgb '#d8dde2' lt 1
set xlabel 'nodes, one core each'
set ylabel 'time until 200 variants are done'
set key top right spacing 1.3 samplen 3
curve(by, launch) = sprintf("< awk -F, '$1 == \"%s\" && $3 == %d' %s", by, launch, csv)
plot curve('part', 1) using 4:5 with linespoints lw 2.5 dt 2 pt 6 ps 0.7 lc rgb '#0a5fb4' title 'by part, 1 s to start a process', \
  curve('triangles=50000', 1) using 4:5 with linespoints lw 2.5 dt 2 pt 4 ps 0.7 lc rgb '#c2570c' title 'by 50,000 triangles, 1 s to start a process', \
  curve('part', 0) using 4:5 with linespoints lw 2.5 pt 7 ps 0.6 lc rgb '#0a5fb4' title 'by part', \
  curve('triangles=50000', 0) using 4:5 with linespoints lw 2.5 pt 5 ps 0.6 lc rgb '#c2570c' title 'by 50,000 triangles', \
  curve('part', 0) using 4:($8/1e9) with lines lw 1.5 dt 3 lc rgb '#667788' title 'what the file server needs for all bytes, at 1 GB/s'
