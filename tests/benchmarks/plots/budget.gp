# SPDX-License-Identifier: BSD-3-Clause
# gnuplot -e "data='FOLDER'; out='FILE.png'; plots='.../plots'" budget.gp
load plots."/style.gp"
set terminal pngcairo size 840,360 font "DejaVu Sans,9.5" background "white"
set output out
set multiplot layout 1,2 margins 0.08,0.985,0.16,0.92 spacing 0.1,0.1
set xlabel "budget [readings]"
set xrange [450:300000]
f(s) = data."/budget_".s.".dat"
# A complete answer has no error: its points lie off the picture.
set key bottom left Left reverse
set format y "%g"
set title "Error of the force against queryWrench(), rms"
set ylabel "part of the force [%]"
set yrange [0.0005:3000]
plot f("peg_pressed") u 1:(100*$3) w lp lc rgb blue pt 7 lw 2 t "peg, pressed 30 µm", \
     f("peg") u 1:(100*$3) w lp lc rgb blue pt 6 dt 2 t "touching lightly", \
     f("gears_pressed") u 1:(100*$3) w lp lc rgb orange pt 7 lw 2 t "gears, pressed 60 µm", \
     f("gears") u 1:(100*$3) w lp lc rgb orange pt 6 dt 2 t "touching lightly", \
     f("screw_pressed") u 1:(100*$3) w lp lc rgb green pt 7 lw 2 t "thread, pressed 20 µm", \
     f("screw") u 1:(100*$3) w lp lc rgb green pt 6 dt 2 t "touching lightly"
set key top left Left reverse
set title "Time of a query"
set ylabel "median [µs]"
set yrange [5:20000]
plot f("peg_pressed") u 1:8 w lp lc rgb blue pt 7 lw 2 t "peg", \
     f("gears_pressed") u 1:8 w lp lc rgb orange pt 7 lw 2 t "gears", \
     f("screw_pressed") u 1:8 w lp lc rgb green pt 7 lw 2 t "thread"
unset multiplot
