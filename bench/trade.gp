# Draws trade-GROUP.dat of `limn_measure trade --plot DIR`:  gnuplot -e "dir='DIR'; group='modelled'" bench/trade.gp
set encoding utf8
data = dir . '/trade-' . group . '.dat'
stats data using 1 nooutput
set xlabel 'frame time, times that of the flat mesh'
set ylabel 'outline error left, % of the flat mesh''s'
set yrange [0:110]
set xrange [0.95:*]
set logscale x
set xtics add (1, 1.1, 1.2, 1.5, 2, 3, 5, 10)
set grid lc rgb '#dddddd'
set key top right
set title 'shapes: ' . group . '; numbers are tolerances in pixels, for pn segments per edge'
colours = "#444444 #b5341c #1a59b6 #2c8a3d"
names = "flat patches curves pn"
do for [kind in 'svg png'] {
  if (kind eq 'svg') { set terminal svg size 760,520 font 'DejaVu Sans,13' background rgb 'white' } \
  else { set terminal pngcairo size 1140,780 font 'DejaVu Sans,13' fontscale 1.3 }
  set output dir . '/trade-' . group . '.' . kind
  plot "< grep ' 1$' ".data." | sort -g" using 1:2 with steps lw 4 lc rgb '#cccccc' title 'nothing beats these', \
    for [i=0:STATS_blocks-1] data index i using 1:2 with linespoints pt 7 ps 0.8 lw 1.5 lc rgb word(colours, i+1) title word(names, i+1), \
    for [i=0:STATS_blocks-1] data index i using 1:2:3 with labels offset 0.6,0.7 left tc rgb word(colours, i+1) notitle
}
