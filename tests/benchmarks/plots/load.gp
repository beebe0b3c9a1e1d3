# SPDX-License-Identifier: BSD-3-Clause
# gnuplot -e "data='FOLDER'; out='load.png'; plots='.../plots'" load.gp: the data of vps_bench_load curve
load plots."/style.gp"
set terminal pngcairo size 1080,360 font "DejaVu Sans,9.5" background "white"
set output out
set multiplot layout 1,3 margins 0.06,0.99,0.16,0.92 spacing 0.06,0.1
f = data."/parts.dat"
set xlabel "parts of 500 triangles"
set xrange [7:20000]

set title "Processor time [s]"
set yrange [0.05:2000]
plot f u 1:2 w lp lc rgb blue pt 7 lw 2 t "explain", \
     f u 1:4 w lp lc rgb orange pt 7 lw 2 t "check, with play", \
     f u 1:6 w lp lc rgb green pt 7 lw 2 t "assemble, one step", \
     [7:20000] 2e-3 * x w l lc rgb grey dt 3 lw 2 t "∝ parts"

set title "Peak memory [GB]"
set yrange [0.01:10]
plot f u 1:3 w lp lc rgb blue pt 7 lw 2 t "explain", \
     f u 1:5 w lp lc rgb orange pt 7 lw 2 t "check", \
     f u 1:7 w lp lc rgb green pt 7 lw 2 t "assemble"

set title "Load [s] and physics step [µs]"
set yrange [0.01:1000]
plot f u 1:8 w lp lc rgb blue pt 7 lw 2 t "load: from parts to models [s]", \
     f u 1:9 w lp lc rgb orange pt 7 lw 2 t "physics step, median [µs]"
unset multiplot
