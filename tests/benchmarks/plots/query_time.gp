# SPDX-License-Identifier: BSD-3-Clause
# gnuplot -e "data='FOLDER'; out='query_time.png'; plots='.../plots'" query_time.gp
load plots."/style.gp"
set terminal pngcairo size 1080,400 font "DejaVu Sans,9.5" background "white"
set output out
set multiplot layout 1,3 margins 0.06,0.99,0.15,0.92 spacing 0.05,0.1
set yrange [1:1e6]
set ylabel "time of one query [µs]"
file(x, s) = data."/".x."_".s.".dat"

set title "Triangles (185,030 points, 512^3)"
set xlabel "triangles of the map's part"
set xrange [300:3e7]
plot data."/triangles.dat" u 1:2 w lp lc rgb blue pt 7 lw 2 t "peg, median", \
     data."/triangles.dat" u 1:3 w lp lc rgb blue pt 8 dt 2 t "peg, p99"

unset ylabel
set title "Points (512^3)"
set xlabel "points of the shell"
set xrange [600:2e6]
plot file("points","screw") u 1:2 w lp lc rgb green pt 7 lw 2 t "bolt in nut", \
     file("points","peg") u 1:2 w lp lc rgb blue pt 7 lw 2 t "peg in hole", \
     file("points","gears") u 1:2 w lp lc rgb orange pt 7 lw 2 t "gears", \
     file("points","peg") u 1:4 w lp lc rgb grey pt 6 t "peg, OpenVDB, every point", \
     [600:2e6] 2e-3 * x w l lc rgb grey dt 3 lw 2 t "∝ points"

set title "Voxels (185,030 points)"
set xlabel "voxels along the longest side"
set xrange [50:1400]
set format x "%g"
set xtics (64, 128, 256, 512, 1024)
plot file("voxels","screw") u 1:2 w lp lc rgb green pt 7 lw 2 t "bolt in nut", \
     file("voxels","peg") u 1:2 w lp lc rgb blue pt 7 lw 2 t "peg in hole", \
     file("voxels","gears") u 1:2 w lp lc rgb orange pt 7 lw 2 t "gears", \
     file("voxels","peg") u 1:4 w lp lc rgb grey pt 6 t "peg, OpenVDB, every point"
unset multiplot
